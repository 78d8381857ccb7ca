#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "exitance/what_if/daylight/daylight_results.hpp"
#include "exitance/what_if/daylight/lm83.hpp"
#include "support/checked_scene.hpp"

namespace exitance {
namespace {

constexpr Point south_low{1, 0, 0.9}, south_high{5, 0, 2.4}, west_low{0, 2, 0.9}, west_high{0, 7, 2.4};

/// A rigid motion: a turn about the vertical by `degrees`, counter-clockwise, then a shift.
struct Motion {
    double degrees = 0;
    Vec3 shift = {};
    Point operator()(const Point& p) const { return turned(p) + shift; }
    Vec3 turned(const Vec3& v) const {
        const double a = degrees * pi / 180;
        return {std::cos(a) * v.x - std::sin(a) * v.y, std::sin(a) * v.x + std::cos(a) * v.y, v.z};
    }
};

/// Fill of the two windows of the room.
enum class Fill { none, glass, black, two_panes };

/// A room of 6 x 9 x 3 m with a window in the south (y = 0) and one in the west (x = 0). Panes: south, then west; with
/// `two_panes`, the south window has a second pane 0.1 m behind the first.
Scene glazed_room(Fill south = Fill::glass, Fill west = Fill::glass, const Motion& motion = {}) {
    SceneDescription d;
    d.file = "room.obj";
    d.materials = {{"grey", Spectrum(0.5), {}}, {"black", Spectrum(0.0), {}}};
    d.groups = {"all"};
    const auto add = [&](const std::vector<Point>& corners, std::uint32_t material = 0) {
        add_polygon(d, corners, motion).material = material;
    };
    const auto in_south = [&](double x0, double x1, double z0, double z1) {
        return std::vector<Point>{{x0, 0, z0}, {x0, 0, z1}, {x1, 0, z1}, {x1, 0, z0}};
    };
    const auto in_west = [&](double y0, double y1, double z0, double z1) {
        return std::vector<Point>{{0, y0, z0}, {0, y1, z0}, {0, y1, z1}, {0, y0, z1}};
    };
    add({{0, 0, 0}, {6, 0, 0}, {6, 9, 0}, {0, 9, 0}}), add({{0, 0, 3}, {0, 9, 3}, {6, 9, 3}, {6, 0, 3}});
    add({{0, 9, 0}, {6, 9, 0}, {6, 9, 3}, {0, 9, 3}}), add({{6, 0, 0}, {6, 0, 3}, {6, 9, 3}, {6, 9, 0}});
    add(in_south(0, 6, 0, 0.9)), add(in_south(0, 6, 2.4, 3));
    add(in_south(0, 1, 0.9, 2.4)), add(in_south(5, 6, 0.9, 2.4));
    add(in_west(0, 9, 0, 0.9)), add(in_west(0, 9, 2.4, 3)), add(in_west(0, 2, 0.9, 2.4)), add(in_west(7, 9, 0.9, 2.4));
    const auto fill = [&](Fill how, std::vector<Point> corners) {
        if (how == Fill::none) return;
        if (how == Fill::black) return add(corners, 1);
        for (Point& p : corners) p = motion(p);
        Pane pane;
        pane.corners = corners, pane.transmissivity = Spectrum(0.9);
        d.panes.push_back(pane);
        for (Point& p : pane.corners) p += motion.turned({0, 0.1, 0});
        if (how == Fill::two_panes) d.panes.push_back(pane);
    };
    fill(south, in_south(south_low.x, south_high.x, south_low.z, south_high.z));
    fill(west, in_west(west_low.y, west_high.y, west_low.z, west_high.z));
    return checked_scene(std::move(d));
}

/// Sunny hours of two days, in winter and summer.
std::vector<DaylightHour> two_days() {
    std::vector<DaylightHour> out;
    for (const int month : {3, 6})
        for (int hour = 1; hour <= 24; ++hour) {
            const bool light = hour > 6 && hour <= 18;
            out.push_back({{2021, month, 21, hour - 0.5, 1}, hour, light ? 120.0 : 0, light ? 500.0 : 0});
        }
    return out;
}

DaylightTask task_of(const Motion& motion = {}) {
    DaylightTask task;
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 9; ++j) task.sensors.push_back({motion({0.5 + i, 0.5 + j, 0.8}), {0, 0, 1}});
    task.grids = {{"", task.sensors.size()}}, task.hours = two_days(), task.error = 0.05;
    // North turns with the room, counter-clockwise.
    task.site = {.place = {47.4, 8.5, 400}, .zone = 1, .north = -motion.degrees};
    return task;
}

/// A group with an open state and one with this factor, that is in `state` in all hours.
PaneGroup constant(const std::string& name, double factor, std::uint8_t state) {
    return {name,
            {{"open", 1, {}}, {"closed", factor, {}}},
            {StateRule::Kind::schedule, std::vector<std::uint8_t>(two_days().size(), state), {}, {}}};
}

DaylightStates states_of(std::uint8_t south, std::uint8_t west, double factor = 0) {
    return {{constant("south", factor, south), constant("west", factor, west)}, {0, 1}, {}, true};
}

DaylightResults year_of(const Scene& scene, DaylightTask task, const DaylightStates* states) {
    Progress progress;
    task.states = states;
    Result<DaylightResults> out = collect_year(scene, task, progress, StopRequest());
    EXI_CHECK(static_cast<bool>(out));
    return std::move(*out);
}

/// Light of all hours at each sensor.
std::vector<double> lux_hours(const DaylightResults& results) {
    std::vector<double> out(results.year.sensors, 0);
    for (std::size_t k = 0; k < results.year.illuminance.size(); ++k)
        out[k % out.size()] += double(results.year.illuminance[k]);
    return out;
}

/// RMS difference over the sensors, relative to the mean of `b`.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
    double squares = 0, mean = 0;
    for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]), mean += b[i];
    return std::sqrt(squares * static_cast<double>(a.size())) / mean;
}

}  // namespace

TEST(DaylightStates, AlwaysTheFirstStateGivesTheBitsWithoutStates) {
    const Scene room = glazed_room();
    const DaylightStates open = states_of(0, 0);
    const DaylightResults with = year_of(room, task_of(), &open), without = year_of(room, task_of(), nullptr);
    EXPECT_EQ(with.year.illuminance, without.year.illuminance);
    EXPECT_EQ(with.year.sun, without.year.sun);
    for (std::size_t i = 0; i < with.sensors.size(); ++i) {
        EXPECT_EQ(with.sensors[i].metrics.autonomy, without.sensors[i].metrics.autonomy);
        EXPECT_EQ(with.sensors[i].intervals.autonomy.high, without.sensors[i].intervals.autonomy.high);
    }
}

TEST(DaylightStates, AClosedGroupIsABlackFaceInItsPlace) {
    const DaylightStates closed = states_of(1, 0);
    const DaylightResults states = year_of(glazed_room(), task_of(), &closed),
                          black = year_of(glazed_room(Fill::black), task_of(), nullptr);
    // The pane mirrors the room's light, and the black face does not: a tenth of the light that meets 6 of 180 m2.
    const double mirrored = 0.01, errors = states.summary.errors[0].lux_hours + black.summary.errors[0].lux_hours;
    EXPECT_LT(difference(lux_hours(states), lux_hours(black)), errors + mirrored);
    EXPECT_EQ(states.year.sun, black.year.sun);
}

TEST(DaylightStates, AFactorOfAPaneIsAPaneWithLessLight) {
    // The share 0.5 of the light of the pane, as by a second pane of a grey film, which does not mirror.
    const DaylightStates half = states_of(1, 1, 0.5), none = states_of(1, 1, 0);
    const Scene room = glazed_room();
    const std::vector<double> open = lux_hours(year_of(room, task_of(), nullptr)),
                              dim = lux_hours(year_of(room, task_of(), &half)),
                              dark = lux_hours(year_of(room, task_of(), &none));
    for (std::size_t i = 0; i < open.size(); ++i) {
        EXPECT_NEAR(dim[i], open[i] / 2, 1e-3 * open[i]) << i;  // all light comes through the panes
        EXPECT_NEAR(dark[i], 0, 1e-3 * open[i]) << i;           // the solve stops with some light left
    }
}

TEST(DaylightStates, AStateOfAShadeChangesAllLight) {
    // A blind in front of the south window, which is a hole here: no light crosses a pane there.
    const Scene open = glazed_room(Fill::none), shut = glazed_room(Fill::black);
    DaylightStates states{{constant("blind", 1, 1)}, {PaneGroups::no_group}, {}, false};
    states.groups[0].has_all_light = true, states.groups[0].states[1].scene = 0;
    states.scenes.push_back({shut, 0, {}});
    const DaylightResults changed = year_of(open, task_of(), &states), whole = year_of(shut, task_of(), nullptr);
    EXPECT_LT(difference(lux_hours(changed), lux_hours(whole)), 0.002);
    states.groups[0] = constant("blind", 1, 0), states.groups[0].has_all_light = true;
    EXPECT_EQ(year_of(open, task_of(), &states).year.illuminance, year_of(open, task_of(), nullptr).year.illuminance);
}

TEST(DaylightStates, TheLightOfGroupsAddsUp) {
    const Scene room = glazed_room();
    const DaylightStates south = states_of(1, 0, 0.2), west = states_of(0, 1, 0.2), both = states_of(1, 1, 0.2);
    const std::vector<double> open = lux_hours(year_of(room, task_of(), nullptr)),
                              a = lux_hours(year_of(room, task_of(), &south)),
                              b = lux_hours(year_of(room, task_of(), &west)),
                              c = lux_hours(year_of(room, task_of(), &both));
    for (std::size_t i = 0; i < open.size(); ++i) EXPECT_NEAR(a[i] + b[i], open[i] + c[i], 1e-4 * open[i]) << i;
}

TEST(DaylightStates, BlindsCloseByTheCountOfSunlitPoints) {
    const Scene room = glazed_room();
    DaylightTask task = task_of();
    DaylightStates states = states_of(0, 0);
    for (PaneGroup& group : states.groups) group.rule.kind = StateRule::Kind::sunlight;
    task.states = &states;
    Progress progress;
    StopRequest stop;
    DaylightSimulation simulation(room, task, progress, stop);
    ASSERT_TRUE(simulation.find_light());
    std::size_t closed = 0;
    for (std::size_t h = 0; h < task.hours.size(); ++h) {
        // The sun's ray through each sensor meets the plane of each window in one point.
        const SunPosition at = sun_position(task.hours[h].time, task.site.place);
        const Normal w = sky_direction(at.altitude, at.azimuth, 0);
        std::size_t south = 0, west = 0;
        for (const ProbePoint& sensor : task.sensors) {
            const Point& x = sensor.x;
            const auto is_lit = [&](const Point& low, const Point& high, double distance, double cosine) {
                if (!(cosine > 0) || !(w.z > 0) || task.hours[h].direct_normal == 0) return false;
                const Point p = x + (distance / cosine) * w;
                const double T = mean(room.panes()[0].transmission(cosine));
                return p.z >= low.z && p.z <= high.z && p.x >= low.x - 1e-9 && p.x <= high.x + 1e-9 &&
                       p.y >= low.y - 1e-9 && p.y <= high.y + 1e-9 && 500 * 100 * w.z * T >= 1000;
            };
            south += is_lit(south_low, south_high, x.y, -w.y), west += is_lit(west_low, west_high, x.x, -w.x);
        }
        EXPECT_EQ(simulation.states()->state[0][h], south > 0.02 * 54) << h;
        EXPECT_EQ(simulation.states()->state[1][h], west > 0.02 * 54) << h;
        closed += simulation.states()->state[0][h];
    }
    EXPECT_GT(closed, 5u);
    EXPECT_LT(closed, 20u);
}

TEST(DaylightStates, ATurnedAndMovedRoomHasTheSameStatesAndLight) {
    const Motion motion{.degrees = 33, .shift = {-40, 25, 3}};
    DaylightStates states = states_of(0, 0, 0.1);
    for (PaneGroup& group : states.groups) group.rule.kind = StateRule::Kind::sunlight;
    const DaylightResults here = year_of(glazed_room(), task_of(), &states),
                          there = year_of(glazed_room(Fill::glass, Fill::glass, motion), task_of(motion), &states);
    const double errors = here.summary.errors[0].lux_hours + there.summary.errors[0].lux_hours;
    EXPECT_LT(difference(lux_hours(there), lux_hours(here)), errors);
    double sun = 0, change = 0;
    for (std::size_t k = 0; k < here.year.sun.size(); ++k)
        sun += double(here.year.sun[k]), change += std::abs(double(here.year.sun[k]) - double(there.year.sun[k]));
    EXPECT_GT(sun, 0);
    EXPECT_LT(change, 1e-3 * sun);  // blinds that close in another hour would change more
}

TEST(DaylightStates, ByIlluminanceTheOpenStateDecides) {
    const Scene room = glazed_room();
    const DaylightResults open = year_of(room, task_of(), nullptr);
    DaylightStates states = states_of(0, 0);
    states.groups[0].states.push_back({"dark", 0, {}});
    states.groups[0].rule = {StateRule::Kind::illuminance, {}, {7, 20}, {1000, 3000}};
    DaylightTask task = task_of();
    task.states = &states;
    Progress progress;
    StopRequest stop;
    DaylightSimulation simulation(room, task, progress, stop);
    ASSERT_TRUE(simulation.find_light());
    std::array<std::size_t, 3> hours{};
    for (std::size_t h = 0; h < task.hours.size(); ++h) {
        const double E = (double(open.year.illuminance[h * 54 + 7]) + double(open.year.illuminance[h * 54 + 20])) / 2;
        const std::size_t state = simulation.states()->state[0][h];
        EXPECT_EQ(state, static_cast<std::size_t>(E > 1000) + static_cast<std::size_t>(E > 3000)) << h;
        ++hours[state];
    }
    for (const std::size_t count : hours) EXPECT_GT(count, 0u);
}

/// Results of variants at every sensor: sensor by sensor.
static std::vector<VariantResult> variants_of(const Scene& scene, const DaylightStates& states) {
    DaylightTask task = task_of();
    task.states = &states;
    std::vector<VariantResult> out;
    Progress progress;
    const auto keep = [&](const DaylightBlock& block) -> Result<void> {
        out.insert(out.end(), block.variants.begin(), block.variants.end());
        return {};
    };
    const StopRequest stop;
    DaylightSimulation simulation(scene, task, progress, stop);
    EXPECT_TRUE(simulation.find_light());
    EXPECT_TRUE(simulation.evaluate({0, task.sensors.size()}, keep));
    return out;
}

TEST(DaylightStates, AVariantHasTheResultsOfARunWithItsFactors) {
    const Scene room = glazed_room();
    DaylightStates open = states_of(0, 0);
    open.variants = {{"as it is", {1, 1}}, {"tinted south", {0.05, 1}}};
    const std::vector<VariantResult> found = variants_of(room, open);
    const DaylightStates tinted = states_of(1, 0, 0.05);
    const DaylightResults clear = year_of(room, task_of(), nullptr), dark = year_of(room, task_of(), &tinted);
    ASSERT_EQ(found.size(), 2 * clear.sensors.size());
    double change = 0;
    for (std::size_t i = 0; i < clear.sensors.size(); ++i) {
        for (const auto& [variant, sensor] :
             {std::pair{found[2 * i], clear.sensors[i]}, std::pair{found[2 * i + 1], dark.sensors[i]}}) {
            EXPECT_EQ(variant.autonomy.value, sensor.metrics.autonomy) << i;
            EXPECT_EQ(variant.autonomy.less, sensor.autonomy.less) << i;
            EXPECT_EQ(variant.autonomy.more, sensor.autonomy.more) << i;
            EXPECT_EQ(variant.autonomy.replicates, sensor.autonomy.replicates) << i;
            EXPECT_NEAR(variant.continuous, sensor.metrics.continuous, 1e-5) << i;  // sums of 32 bits
        }
        EXPECT_EQ(found[2 * i].sunny_hours, clear.sensors[i].metrics.sunny_hours) << i;
        change += found[2 * i].autonomy.value - found[2 * i + 1].autonomy.value;
    }
    EXPECT_GT(change, 0);
}

TEST(DaylightStates, BlindsOfAVariantCloseByTheSunlightThroughItsGlass) {
    const Scene room = glazed_room();
    DaylightStates states = states_of(0, 0, 0);
    for (PaneGroup& group : states.groups) group.rule.kind = StateRule::Kind::sunlight;
    // Sunlight is at most 50,000 lx. Behind the darkest glass it never has 1000 lx, and no blinds close.
    states.variants = {{"as it is", {1, 1}}, {"darkest", {0.015, 0.015}}};
    const std::vector<VariantResult> found = variants_of(room, states);
    const DaylightResults results = year_of(room, task_of(), &states), open = year_of(room, task_of(), nullptr);
    const std::size_t n = results.sensors.size();
    for (std::size_t i = 0; i < n; ++i) {
        EXPECT_EQ(found[2 * i].autonomy.value, results.sensors[i].metrics.autonomy) << i;
        double mean = 0;
        for (std::size_t h = 0; h < 48; ++h)
            if (is_working_hour(static_cast<int>(h % 24) + 1)) mean += double(open.year.illuminance[h * n + i]) / 20;
        EXPECT_NEAR(found[2 * i + 1].illuminance, 0.015 * mean, 2e-3 * mean) << i;  // the last sweep of the solve
    }
}

TEST(DaylightStates, LightThatCrossesTwoGroupsIsMeasured) {
    // Most light of the second pane has crossed the first one, which is of another group.
    const Scene two = glazed_room(Fill::two_panes, Fill::black);
    ASSERT_EQ(two.panes().size(), 2u);
    DaylightStates states{{constant("outer", 0, 1), constant("inner", 0, 0)}, {0, 1}, {}, true};
    DaylightTask task = task_of();
    Progress progress;
    task.states = &states;
    StopRequest stop;
    DaylightSimulation in_series(two, task, progress, stop);
    ASSERT_TRUE(in_series.find_light());
    EXPECT_GT(in_series.states()->twice, 0.9);
    DaylightStates side_by_side = states_of(0, 0);
    task.states = &side_by_side;
    const Scene room = glazed_room();
    DaylightSimulation beside(room, task, progress, stop);
    ASSERT_TRUE(beside.find_light());
    EXPECT_LT(beside.states()->twice, 1e-3);
}

TEST(DaylightStates, ConformityWithLm83HasItsReasons) {
    DaylightTask task = task_of();
    EXPECT_EQ(lm83_deviations(task, true).exposure.size(), 2u);  // two days, points 1 m apart
    DaylightTask year;
    for (int i = 0; i < 10; ++i) year.sensors.push_back({{0.6 * i, 0, 0.8}, {0, 0, 1}});
    year.grids = {{"", 10}};
    for (int h = 0; h < 8760; ++h) year.hours.push_back({{}, h % 24 + 1, 0, 0});
    DaylightStates states = states_of(0, 0);
    EXPECT_TRUE(lm83_deviations(year, true).exposure.empty());
    EXPECT_EQ(lm83_deviations(year, true).autonomy, std::vector<std::string>{"blinds are not operated"});
    year.states = &states;
    EXPECT_EQ(lm83_deviations(year, true).autonomy.size(), 2u);
    for (PaneGroup& group : states.groups) group.rule.kind = StateRule::Kind::sunlight;
    EXPECT_TRUE(lm83_deviations(year, true).autonomy.empty());
    year.criteria.target = 500;
    EXPECT_EQ(lm83_deviations(year, true).autonomy.size(), 1u);
    EXPECT_EQ(lm83_deviations(year, false).exposure.size(), 1u);
}

}  // namespace exitance
