#include <gtest/gtest.h>

#include <cmath>

#include "exitance/methods/solve_scene.hpp"
#include "exitance/reference/path_reference.hpp"
#include "exitance/what_if/daylight/daylight_results.hpp"
#include "support/solved.hpp"

namespace exitance {
namespace {

/// Ground, or a room of 3 x 4 x 2.5 m whose wall at y = 0 has an opening from z = 1 to 2.
Scene scene(bool room, const DistantLight& light = {}) {
    SceneDescription d;
    d.file = "day.obj";
    d.materials = {{"grey", Spectrum(0.5), {}}};
    d.groups = {"all"};
    const auto add = [&](const std::vector<Point>& corners) {
        d.faces.push_back({{}, 0, 0, 0});
        for (const Point& p : corners) {
            d.faces.back().corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            d.points.push_back(p);
        }
    };
    add({{0, 0, 0}, {3, 0, 0}, {3, 4, 0}, {0, 4, 0}});
    if (room) {
        add({{0, 0, 2.5}, {0, 4, 2.5}, {3, 4, 2.5}, {3, 0, 2.5}});
        add({{0, 4, 0}, {3, 4, 0}, {3, 4, 2.5}, {0, 4, 2.5}});
        add({{0, 0, 0}, {0, 4, 0}, {0, 4, 2.5}, {0, 0, 2.5}});
        add({{3, 0, 0}, {3, 0, 2.5}, {3, 4, 2.5}, {3, 4, 0}});
        add({{0, 0, 0}, {0, 0, 1}, {3, 0, 1}, {3, 0, 0}});
        add({{0, 0, 2}, {0, 0, 2.5}, {3, 0, 2.5}, {3, 0, 2}});
    }
    d.distant = light;
    CheckedScene checked = make_scene(std::move(d));
    EXI_CHECK(static_cast<bool>(checked.scene));
    return std::move(*checked.scene);
}

std::vector<DaylightHour> day() {
    std::vector<DaylightHour> out;
    for (int hour = 1; hour <= 24; ++hour) {
        const bool light = hour > 7 && hour <= 19;
        out.push_back({{2021, 6, 21, hour - 0.5, 1}, hour, light ? 120.0 : 0, light ? 500.0 : 0});
    }
    return out;
}

}  // namespace

TEST(Daylight, InTheOpenAgreesWithTheWeather) {
    const Scene open = scene(false);
    const SkyPatches patches(1);
    const std::vector<ProbePoint> sensors{{{1, 1, 0}, {0, 0, 1}}, {{1, 1, 1}, {0, 0, 1}}};
    Progress progress;
    const DaylightMatrix matrix = make_daylight_matrix(
        open, sensors, patches, {.elements = 50, .rays_an_element = 64, .rays_a_sensor = 64}, progress);
    const std::vector<DaylightHour> hours = day();
    const DaylightSite site{.place = {47.4, 8.5, 400}};
    const DaylightYear year = daylight_year(open, sensors, matrix, YearSky(patches, hours, site));
    const auto metrics = daylight_metrics(year, patches, matrix, hours, site);
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        EXPECT_NEAR(metrics[i].daylight_factor, 100, 0.2);
        EXPECT_EQ(metrics[i].autonomy, 1);
        EXPECT_EQ(metrics[i].useful[3], 1);
        const SunPosition sun = sun_position(hours[12].time, site.place);
        EXPECT_NEAR(year.illuminance[12 * 2 + i], 120 * 120 + 500 * 100 * std::sin(sun.altitude * pi / 180), 50);
        EXPECT_EQ(year.illuminance[3 * 2 + i], 0);
    }
    const DaylightSummary summary = summarize(metrics, hours);
    EXPECT_EQ(summary.occupied_hours, 10u);
    EXPECT_EQ(summary.spatial_autonomy, 1);
    EXPECT_EQ(summary.sunlight_exposure, 0);  // a day has less than 250 hours
}

TEST(Daylight, InARoomAgreesWithASolveUnderTheSameSky) {
    SkyModel below = uniform_sky();
    below.below = true;
    const Scene lit = scene(true, {{{overcast_sky(), Spectrum(100.0)}, {below, Spectrum(20.0)}}, {}});
    const Solution solution = solved(lit, {.error = 0.03});
    const std::vector<ProbePoint> sensors{
        {{1.5, 1, 0.8}, {0, 0, 1}}, {{1.5, 3, 0.8}, {0, 0, 1}}, {{0.7, 2, 0}, {0, 0, 1}}};
    const std::vector<Light> light = RadiosityFunction(solution).at(sensors);
    const SkyPatches patches(1);
    Progress progress;
    const DaylightMatrix matrix =
        make_daylight_matrix(scene(true), sensors, patches, {.elements = 800, .rays_an_element = 128}, progress);
    const DaylightSite site{.place = {}, .ground = 0.2};
    const auto metrics = daylight_metrics({sensors.size(), {}, {}}, patches, matrix, {}, site);
    for (std::size_t i = 0; i < sensors.size(); ++i)
        EXPECT_NEAR(metrics[i].daylight_factor, light[i].irradiance[0], 0.04 * light[i].irradiance[0]) << i;
}

TEST(Daylight, OnTheEdgeOfAWallIsThatInside) {
    // Sensors on the edges of walls and in free space in the plane of a wall have the light inside the room. At
    // neighbouring points it differs by a few tenths of a per cent, and some rays of reflected light hit another
    // element.
    const Scene dark = scene(true);
    const std::vector<ProbePoint> on{{{0, 2, 0}, {0, 0, 1}},
                                     {{1.5, 4, 0}, {0, 0, 1}},
                                     {{3, 4, 0}, {0, 0, 1}},
                                     {{0, 2, 1}, {0, 0, 1}},
                                     {{0, 2, 0}, {1, 0, 0}}};
    std::vector<ProbePoint> beside = on;
    constexpr double step_inside = 1e-3;  // metres
    beside[0].x.x += step_inside, beside[1].x.y -= step_inside, beside[2].x.x -= step_inside,
        beside[2].x.y -= step_inside;
    beside[3].x.x += step_inside, beside[4].x.z += step_inside;
    const SkyPatches patches(1);
    const DaylightSite site{.place = {47.4, 8.5, 400}};
    Progress progress;
    const auto factors = [&](const std::vector<ProbePoint>& sensors) {
        const DaylightMatrix matrix = make_daylight_matrix(
            dark, sensors, patches, {.elements = 300, .rays_an_element = 64, .rays_a_sensor = 1024}, progress);
        return daylight_metrics({sensors.size(), {}, {}}, patches, matrix, {}, site);
    };
    const auto found = factors(on), expected = factors(beside);
    const std::vector<double> hours = sunlight_hours(dark, on, site, 1, {}),
                              hours_beside = sunlight_hours(dark, beside, site, 1, {});
    for (std::size_t i = 0; i < on.size(); ++i) {
        ASSERT_GT(expected[i].daylight_factor, 0.05);
        EXPECT_NEAR(found[i].daylight_factor / expected[i].daylight_factor, 1, 0.02) << i;
        EXPECT_NEAR(hours[i], hours_beside[i], 1.0 / 15) << i;  // two steps of two minutes
    }
}

/// A grid of 6 x 4 sensors in the room.
std::vector<ProbePoint> desk_sensors() {
    std::vector<ProbePoint> out;
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 4; ++j) out.push_back({{0.25 + 0.5 * i, 0.5 + j, 0.8}, {0, 0, 1}});
    return out;
}

TEST(Daylight, TheToldErrorAndTheIntervalsCoverTheTrueOnes) {
    const Scene room = scene(true);
    const DaylightSite site{.place = {47.4, 8.5, 400}, .ground = 0.2};
    DaylightResults results;
    results.sensors = desk_sensors(), results.grids = {{"near", 12}, {"far", 12}}, results.hours = day();
    Progress progress;
    constexpr double requested = 0.05;
    ASSERT_TRUE(simulate_year(room, 1, site, requested, results, progress, StopRequest()));
    ASSERT_EQ(results.errors.size(), 2u);

    // Daylight factors by unbiased paths; their standard error is a tenth of the requested error.
    SkyModel below = uniform_sky();
    below.below = true;
    const Scene lit = scene(true, {{{overcast_sky(), Spectrum(100.0)}, {below, Spectrum(20.0)}}, {}});
    const std::vector<ReferenceLight> exact = reference_light(lit, results.sensors, 16'384, 7, progress, StopRequest());
    std::size_t covered = 0;
    for (std::size_t g = 0; g < 2; ++g) {
        double mean = 0, squares = 0;
        for (std::size_t i = 12 * g; i < 12 * (g + 1); ++i) {
            const double E = exact[i].irradiance[0], found = results.metrics[i].daylight_factor;
            mean += E / 12, squares += (found - E) * (found - E) / 12;
            const Interval& factor = results.intervals.sensors[i].factor;
            const double noise = 2 * exact[i].standard_error[0];
            covered += factor.low - noise <= E && E <= factor.high + noise;
            EXPECT_LE(factor.low, found);
            EXPECT_GE(factor.high, found);
        }
        const double error = std::sqrt(squares) / mean;
        EXPECT_LE(results.errors[g].factor, requested);
        // Twelve sensors share the noise of the elements, so that the true error varies by half of its mean.
        EXPECT_LT(error, 1.5 * results.errors[g].factor) << g;
    }
    EXPECT_GE(covered, 21u);  // of 24, for 95%: fewer than 21 happen in one of 30 runs of independent sensors
}

TEST(YearSky, TilesGiveTheBitsOfPlainSums) {
    // 19 sensors do not fill two tiles of 16. The day is cut so that bright hours do not fill tiles of 4.
    const SkyPatches patches(1);
    std::vector<DaylightHour> hours = day();
    hours.resize(17);
    const YearSky sky(patches, hours, {.place = {47.4, 8.5, 400}});
    ASSERT_NE(sky.bright_hours().size() % 4, 0u);
    constexpr std::size_t sensors = 19;
    const std::size_t m = patches.size();
    std::vector<float> coefficients(sensors * m);
    for (std::size_t k = 0; k < coefficients.size(); ++k) coefficients[k] = 1 / static_cast<float>(1 + k % 997);
    // Light of one patch in one hour, by a matrix with one coefficient.
    std::vector<float> luminance(m * hours.size());
    for (std::size_t p = 0; p < m; ++p) {
        std::vector<float> one(m, 0), lux(hours.size(), 0);
        one[p] = 1;
        sky.add_sky(one, lux);
        for (std::size_t h = 0; h < hours.size(); ++h) luminance[h * m + p] = lux[h];
    }
    std::vector<float> lux(sensors * hours.size(), 1);
    sky.add_sky(coefficients, lux);
    for (std::size_t i = 0; i < sensors; ++i)
        for (std::size_t h = 0; h < hours.size(); ++h) {
            float sum = 0;
            for (std::size_t p = 0; p < m; ++p) sum += coefficients[i * m + p] * luminance[h * m + p];
            EXPECT_EQ(lux[i * hours.size() + h], 1 + sum) << i << ' ' << h;
        }
}

TEST(Daylight, OneColumnIsTheProductOfTheMatrixWithASky) {
    // Both use equal rays, so that only rounding to 32 bits and the last sweep of each solve (2e-4) differ. Reflected
    // light of another sky than the straight light shows a mix-up of the two.
    const Scene room = scene(true);
    const std::vector<ProbePoint> sensors = desk_sensors();
    const SkyPatches patches(2);
    std::vector<double> sky, reflected;
    for (std::size_t p = 0; p < patches.size(); ++p)
        sky.push_back(100 + 7 * double(p % 11)), reflected.push_back(p % 5 == 0 ? 0 : 300 + double(p));
    const DaylightOptions options{.elements = 300, .rays_an_element = 64, .rays_a_sensor = 256};
    Progress progress;
    const DaylightMatrix matrix = make_daylight_matrix(room, sensors, patches, options, progress),
                         column = make_daylight_column(room, sensors, patches, sky, reflected, options, progress);
    ASSERT_EQ(column.sensors(), sensors.size());
    ASSERT_EQ(column.patches, 1u);
    constexpr double last_sweep = 1e-3;
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        double straight = 0;
        std::array<double, daylight_replicates> after{};
        for (std::size_t p = 0; p < patches.size(); ++p) {
            straight += sky[p] * double(matrix.direct[i * patches.size() + p]);
            for (std::size_t k = 0; k < daylight_replicates; ++k)
                after[k] += reflected[p] * double(matrix.replicates[k][i * patches.size() + p]);
        }
        EXPECT_NEAR(double(column.direct[i]), straight, 1e-5 * straight) << i;
        for (std::size_t k = 0; k < daylight_replicates; ++k) {
            ASSERT_GT(after[k], 0);
            EXPECT_NEAR(double(column.replicates[k][i]), after[k], last_sweep * after[k]) << i;
        }
    }
}

TEST(Daylight, ASmallerRequestedErrorIsReached) {
    const Scene room = scene(true);
    DaylightResults results;
    results.sensors = desk_sensors(), results.grids = {{"", 24}}, results.hours = day();
    Progress progress;
    for (const double requested : {0.2, 0.01}) {
        ASSERT_TRUE(simulate_year(room, 2, {.place = {47.4, 8.5, 400}}, requested, results, progress, StopRequest()));
        EXPECT_LE(results.errors[0].factor, requested);
        EXPECT_GT(results.errors[0].factor, 0);
    }
}

}  // namespace exitance
