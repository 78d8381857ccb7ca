#include "exitance/what_if/daylight/glare_year.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/what_if/daylight/daylight_results.hpp"
#include "support/checked_scene.hpp"
#include "support/daylight_room.hpp"

namespace exitance {
namespace {

constexpr double threshold = 2000;  ///< cd/m^2

/// A black room of 3 x 4 x 2.5 m whose wall at y = 0 has an opening from z = 1 to 2.
Scene black_room() {
    SceneDescription d;
    d.materials = {{"black", Spectrum(), {}}};
    d.groups = {"all"};
    add_daylight_room(d);
    return checked_scene(std::move(d));
}

/// Hours from 9 to 16 h of a day in December; the opening faces south.
DaylightTask day(double direct) {
    DaylightTask task;
    task.sensors = {{{1.5, 2, 0.8}, {0, 0, 1}}}, task.grids = {{"", 1}};
    for (int hour = 9; hour <= 16; ++hour) task.hours.push_back({{2021, 12, 21, hour - 0.5, 1}, hour, 180, direct});
    task.site = {.place = {47.4, 8.5, 400}, .zone = 1};
    task.error = 0.2;
    return task;
}

std::vector<GlareYear> glare_of(const Scene& scene, const DaylightTask& task, const std::vector<ProbePoint>& views) {
    Progress progress;
    const StopRequest stop;
    DaylightSimulation simulation(scene, task, progress, stop);
    EXPECT_TRUE(simulation.find_light());
    const Result<std::vector<GlareYear>> years = simulation.glare(views, threshold);
    EXPECT_TRUE(years);
    return *years;
}

/// DGP in the black room from a raster of 600 x 600 directions through the opening, which shows one source of sky
/// (and one of its peaks), and from the sun.
double raster_of(const ProbePoint& view, std::span<const float> luminances, const SkyPatches& patches,
                 const YearSky::Sun& sun) {
    constexpr int n = 600;
    double E_v = 0;
    std::array<double, 2> light{}, omega{};
    std::array<Vec3, 2> centre;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const Vec3 d = Point{3 * (i + 0.5) / n, 0, 1 + (k + 0.5) / n} - view.x;
            const double angle = 3.0 / n / n * -d.y / std::pow(norm(d), 3), cosine = dot(normalized(d), view.n);
            if (cosine <= 0) continue;
            const double L = double(luminances[patches.of(normalized(d))]);
            E_v += L * angle * cosine;
            const std::size_t s = L >= peak_luminance ? 1 : 0;
            if (L > threshold) light[s] += L * angle, omega[s] += angle, centre[s] += L * angle * normalized(d);
        }
    double terms = 0;
    for (std::size_t s = 0; s < 2; ++s)
        if (omega[s] > 0) terms += light[s] * light[s] / omega[s] / std::pow(daylight_position(view.n, centre[s]), 2);
    const Vec3 towards = sun.towards;
    const double z = view.x.z - view.x.y / towards.y * towards.z, x = view.x.x - view.x.y / towards.y * towards.x;
    if (sun.illuminance > 0 && towards.y < 0 && x > 0 && x < 3 && z > 1 && z < 2 && dot(towards, view.n) > 0) {
        const double half = 0.533 / 2 * pi / 180, disc = 2 * pi * (1 - std::cos(half));
        E_v += sun.illuminance * dot(towards, view.n);
        terms += sun.illuminance * sun.illuminance / disc / std::pow(daylight_position(view.n, towards), 2);
    }
    return daylight_glare_probability(E_v, terms);
}

}  // namespace

TEST(GlareYears, InABlackRoomAgreeWithARaster) {
    const Scene room = black_room();
    const std::vector<ProbePoint> views{{{1.5, 3, 1.2}, {0, -1, 0}},
                                        {{1, 2, 1.3}, normalized({0.5, -1, 0.1})},
                                        {{2.5, 1, 1.6}, {-1, 0, 0}},
                                        {{1.5, 3.5, 1.2}, {0, 1, 0}}};
    const SkyPatches patches(1);
    std::size_t suns = 0;
    for (const double direct : {0.0, 600.0}) {
        const DaylightTask task = day(direct);
        const YearSky sky(patches, task.hours, task.site);
        const std::vector<GlareYear> years = glare_of(room, task, views);
        ASSERT_EQ(years.size(), views.size());
        for (std::size_t i = 0; i < views.size(); ++i)
            for (std::size_t k = 0; k < sky.bright_hours().size(); ++k) {
                const std::size_t h = sky.bright_hours()[k];
                const double expected = raster_of(views[i], sky.sky_luminances(k), patches, sky.sun(h));
                // Triangles of 0.05 rad belong whole to the patch of their middle.
                EXPECT_NEAR(years[i].probability[h], expected, 0.005) << i << ' ' << h << ' ' << direct;
                suns += expected > 0.6;
            }
    }
    EXPECT_GT(suns, 0u) << "some view sees the sun";
}

TEST(GlareYears, AreTheSameOnAnyNumberOfThreads) {
    const Scene room = black_room();
    const std::vector<ProbePoint> views{{{1.5, 3, 1.2}, {0, -1, 0}}, {{1, 2, 1.3}, {1, 0, 0}}};
    set_threads(1);
    const std::vector<GlareYear> one = glare_of(room, day(600), views);
    set_threads(3);
    const std::vector<GlareYear> three = glare_of(room, day(600), views);
    set_threads(0);
    for (std::size_t i = 0; i < views.size(); ++i) EXPECT_EQ(one[i].probability, three[i].probability);
}

TEST(GlareStatistics, CountOccupiedHoursAboveEachLimit) {
    std::vector<DaylightHour> hours(100);
    for (DaylightHour& hour : hours) hour.hour = 12;
    std::vector<float> probabilities(100, 0.3F);
    const auto level = [&](int above, float value) {
        std::fill(probabilities.begin(), probabilities.end(), 0.3F);
        std::fill_n(probabilities.begin(), above, value);
        return glare_statistics(probabilities, hours, {}).level();
    };
    EXPECT_EQ(level(5, 0.9F), 3) << "5% may exceed the limit";
    EXPECT_EQ(level(6, 0.9F), 0);
    EXPECT_EQ(level(6, 0.44F), 1);
    EXPECT_EQ(level(6, 0.39F), 2);
    const GlareStatistics s = glare_statistics(probabilities, hours, {});
    EXPECT_DOUBLE_EQ(s.exceeded[0], 0.06);
    EXPECT_DOUBLE_EQ(s.exceeded[1], 0);
    EXPECT_FLOAT_EQ(static_cast<float>(s.worst), 0.39F);
    EXPECT_FLOAT_EQ(static_cast<float>(s.reached), 0.39F);
    DaylightCriteria empty_at_noon;
    empty_at_noon.occupied.assign(100, 0), empty_at_noon.occupied[50] = 1;
    EXPECT_EQ(glare_statistics(probabilities, hours, empty_at_noon).level(), 3);
}

TEST(GlareSummary, HasTheLevelThatAllViewsReach) {
    std::vector<GlareYear> years(4);
    years[0].statistics.exceeded = {0, 0, 0};
    years[1].statistics.exceeded = {0.1, 0, 0};
    years[2].statistics.exceeded = {0.1, 0.1, 0};
    years[3].statistics.exceeded = {0, 0, 0}, years[3].statistics.reached = 0.2;
    const GlareSummary all = summary_of(years);
    EXPECT_EQ(all.level, 1);
    EXPECT_EQ(all.at_level, (std::array<double, 3>{1, 0.75, 0.5}));
    EXPECT_DOUBLE_EQ(all.worst, 0.2);
}

}  // namespace exitance
