#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/sanitizers.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/reference/path_reference.hpp"
#include "exitance/what_if/daylight/daylight_results.hpp"
#include "exitance/what_if/daylight/sensor_places.hpp"
#include "support/checked_scene.hpp"
#include "support/daylight_room.hpp"
#include "support/solved.hpp"

namespace exitance {
namespace {

/// Ground, or a room of 3 x 4 x 2.5 m whose wall at y = 0 has an opening from z = 1 to 2.
Scene scene(bool room, const DistantLight& light = {}) {
    SceneDescription d;
    d.file = "day.obj";
    d.materials = {{"grey", Spectrum(0.5), {}}};
    d.groups = {"all"};
    if (room)
        add_daylight_room(d);
    else
        add_polygon(d, {{0, 0, 0}, {3, 0, 0}, {3, 4, 0}, {0, 4, 0}});
    d.distant = light;
    return checked_scene(std::move(d));
}

std::vector<DaylightHour> day() {
    std::vector<DaylightHour> out;
    for (int hour = 1; hour <= 24; ++hour) {
        const bool light = hour > 7 && hour <= 19;
        out.push_back({{2021, 6, 21, hour - 0.5, 1}, hour, light ? 120.0 : 0, light ? 500.0 : 0});
    }
    return out;
}

DaylightTask task_of(std::vector<ProbePoint> sensors, std::vector<SensorGrid> grids) {
    DaylightTask task;
    task.sensors = std::move(sensors), task.grids = std::move(grids), task.hours = day();
    return task;
}

}  // namespace

TEST(Daylight, InTheOpenAgreesWithTheWeather) {
    const Scene open = scene(false);
    DaylightTask task = task_of({{{1, 1, 0}, {0, 0, 1}}, {{1, 1, 1}, {0, 0, 1}}}, {{"", 2}});
    task.site = {.place = {47.4, 8.5, 400}};
    Progress progress;
    const Result<DaylightResults> results = collect_year(open, task, progress, StopRequest());
    ASSERT_TRUE(results);
    for (std::size_t i = 0; i < task.sensors.size(); ++i) {
        const DaylightMetrics& metrics = results->sensors[i].metrics;
        EXPECT_NEAR(metrics.daylight_factor, 100, 0.2);
        EXPECT_EQ(metrics.autonomy, 1);
        EXPECT_EQ(metrics.useful[3], 1);
        const SunPosition sun = sun_position(task.hours[12].time, task.site.place);
        EXPECT_NEAR(results->year.illuminance[12 * 2 + i], 120 * 120 + 500 * 100 * std::sin(sun.altitude * pi / 180),
                    50);
        EXPECT_EQ(results->year.illuminance[3 * 2 + i], 0);
    }
    EXPECT_EQ(results->summary.occupied_hours, 10u);
    EXPECT_EQ(results->summary.spatial_autonomy, 1);
    EXPECT_EQ(results->summary.sunlight_exposure, 0);  // a day has less than 250 hours
}

/// Daylight matrix of all sensors.
DaylightMatrix matrix_of(const Scene& scene, std::span<const ProbePoint> sensors, const SkyPatches& patches,
                         const DaylightOptions& options) {
    DaylightTransport transport(scene, patches, nullptr, options.seed);
    transport.make_elements(options.elements);
    transport.cast_rows(options.rays_an_element);
    const ElementLight light = transport.solve(SkyColumns::of_patches(patches.size()));
    const std::vector<SurfacePoint> places = sensor_places(scene, transport.stage().occluders, sensors);
    return DaylightRows(transport, light, patches, options.rays_a_sensor).rows(places, 0, [](std::size_t) {
        return nullptr;
    });
}

/// Daylight factor of every sensor, per cent.
static std::vector<double> daylight_factors(const DaylightMatrix& matrix, const SkyPatches& patches) {
    constexpr double ground = 0.2;
    const std::vector<double> overcast = overcast_luminances(patches, ground);
    std::vector<double> out(matrix.sensors(), 0);
    for (std::size_t i = 0; i < out.size(); ++i)
        for (std::size_t p = 0; p < matrix.patches; ++p) out[i] += overcast[p] * matrix.total(i, p);
    return out;
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
    const DaylightMatrix matrix = matrix_of(scene(true), sensors, patches, {.elements = 800, .rays_an_element = 128});
    const std::vector<double> factors = daylight_factors(matrix, patches);
    for (std::size_t i = 0; i < sensors.size(); ++i)
        EXPECT_NEAR(factors[i], light[i].irradiance[0], 0.04 * light[i].irradiance[0]) << i;
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
    const DaylightSite site{.place = {47.4, 8.5, 400}, .zone = 1};
    Progress progress;
    const auto factors = [&](const std::vector<ProbePoint>& sensors) {
        const DaylightMatrix matrix =
            matrix_of(dark, sensors, patches, {.elements = 300, .rays_an_element = 64, .rays_a_sensor = 1024});
        return daylight_factors(matrix, patches);
    };
    const auto found = factors(on), expected = factors(beside);
    const Occluders occluders(dark);
    const std::vector<SurfacePoint> places = sensor_places(dark, occluders, on),
                                    places_beside = sensor_places(dark, occluders, beside);
    const SunlightHours sunlight(occluders, site, {});
    for (std::size_t i = 0; i < on.size(); ++i) {
        ASSERT_GT(expected[i], 0.05);
        EXPECT_NEAR(found[i] / expected[i], 1, 0.02) << i;
        EXPECT_NEAR(sunlight.at(places[i]), sunlight.at(places_beside[i]), 1.0 / 15) << i;  // two steps of two minutes
    }
}

/// A grid of 6 x 4 sensors in the room.
static std::vector<ProbePoint> desk_sensors() {
    std::vector<ProbePoint> out;
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 4; ++j) out.push_back({{0.25 + 0.5 * i, 0.5 + j, 0.8}, {0, 0, 1}});
    return out;
}

TEST(Daylight, TheToldErrorAndTheIntervalsCoverTheTrueOnes) {
    const Scene room = scene(true);
    DaylightTask task = task_of(desk_sensors(), {{"near", 12}, {"far", 12}});
    task.site = {.place = {47.4, 8.5, 400}, .ground = 0.2}, task.error = 0.05;
    Progress progress;
    const Result<DaylightResults> results = collect_year(room, task, progress, StopRequest());
    ASSERT_TRUE(results);
    ASSERT_EQ(results->summary.errors.size(), 2u);

    // Daylight factors by unbiased paths; their standard error is a tenth of the requested error.
    SkyModel below = uniform_sky();
    below.below = true;
    const Scene lit = scene(true, {{{overcast_sky(), Spectrum(100.0)}, {below, Spectrum(20.0)}}, {}});
    const std::vector<ReferenceLight> exact = reference_light(lit, task.sensors, 16'384, 7, progress, StopRequest());
    std::size_t covered = 0;
    for (std::size_t g = 0; g < 2; ++g) {
        double mean = 0, squares = 0;
        for (std::size_t i = 12 * g; i < 12 * (g + 1); ++i) {
            const double E = exact[i].irradiance[0], found = results->sensors[i].metrics.daylight_factor;
            mean += E / 12, squares += (found - E) * (found - E) / 12;
            const Interval& factor = results->sensors[i].intervals.factor;
            const double noise = 2 * exact[i].standard_error[0];
            covered += factor.low - noise <= E && E <= factor.high + noise;
            EXPECT_LE(factor.low, found);
            EXPECT_GE(factor.high, found);
        }
        const double error = std::sqrt(squares) / mean;
        EXPECT_LE(results->summary.errors[g].factor, task.error);
        // Twelve sensors share the noise of the elements, so that the true error varies by half of its mean.
        EXPECT_LT(error, 1.5 * results->summary.errors[g].factor) << g;
    }
    EXPECT_GE(covered, 21u);  // of 24 bounds at 95%, fewer than 21 hold in one of 30 runs of independent sensors
}

TEST(DaylightMetrics, CriteriaChooseHoursAndThresholds) {
    // Hours that end at 9 to 12, with 50 to 1000 lx; the last one is sunny.
    std::vector<DaylightHour> hours(4);
    for (int h = 0; h < 4; ++h) hours[static_cast<std::size_t>(h)].hour = 9 + h;
    const std::vector<float> lux{50, 250, 500, 1000}, sun{0, 0, 0, 2000};
    const DaylightMetrics standard = metrics_of(2, lux, sun, hours, {});
    EXPECT_EQ(standard.autonomy, 0.5);
    EXPECT_EQ(standard.useful, (std::array<double, 4>{0.25, 0.25, 0.5, 0}));
    EXPECT_EQ(standard.sunny_hours, 1);
    EXPECT_NEAR(standard.continuous, (50.0 / 300 + 250.0 / 300 + 2) / 4, 1e-12);
    EXPECT_NEAR(standard.electric_hours, 250.0 / 300 + 50.0 / 300, 1e-12);
    const DaylightCriteria criteria{
        .occupied = {1, 0, 1, 0}, .target = 500, .useful = {40, 400, 500}, .dimmed_power = 0.2};
    const DaylightMetrics own = metrics_of(2, lux, sun, hours, criteria);
    EXPECT_EQ(own.autonomy, 0.5);
    EXPECT_EQ(own.useful, (std::array<double, 4>{0, 0.5, 0, 0.5}));
    EXPECT_EQ(own.sunny_hours, 0);
    EXPECT_NEAR(own.continuous, (0.1 + 1) / 2, 1e-12);
    EXPECT_NEAR(own.electric_hours, (0.2 + 0.8 * 0.9) + 0.2, 1e-12);
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

TEST(DaylightTransport, ColumnsAreProductsOfTheMatrixWithASky) {
    // Both use equal rays, so that only rounding to 32 bits and the last sweep of each solve (2e-4) differ.
    const Scene room = scene(true);
    const SkyPatches patches(1), finer(2);
    DaylightTransport transport(room, patches, &finer, 1);
    transport.make_elements(300);
    transport.cast_rows(64);
    std::vector<double> sky, finer_sky;
    for (std::size_t p = 0; p < patches.size(); ++p) sky.push_back(p % 5 == 0 ? 0 : 300 + double(p));
    for (std::size_t p = 0; p < finer.size(); ++p) finer_sky.push_back(200);
    SkyColumns columns;
    columns.add(sky), columns.add_finer(finer_sky), columns.add(std::vector<double>(patches.size(), 200));
    const ElementLight column = transport.solve(columns),
                       matrix = transport.solve(SkyColumns::of_patches(patches.size()));
    SensorRays rays;
    transport.cast_sensor({{1.5, 2, 0.8}, {0, 0, 1}, RegionId()}, 0, 256, rays);
    constexpr double last_sweep = 1e-3;
    for (std::size_t k = 0; k < daylight_replicates; ++k) {
        std::vector<float> row(patches.size()), light(3);
        matrix.gather(k, rays[k], row), column.gather(k, rays[k], light);
        double expected = 0;
        for (std::size_t p = 0; p < patches.size(); ++p) expected += sky[p] * double(row[p]);
        ASSERT_GT(expected, 0);
        EXPECT_NEAR(double(light[0]), expected, last_sweep * expected) << k;
        EXPECT_NEAR(light[1], light[2], 1e-5 * light[2]) << k;  // a uniform sky is the same in all patches
    }
}

TEST(DaylightTransport, AddedRaysGiveTheBitsOfAllRaysAtOnce) {
    const Scene room = scene(true);
    const SkyPatches patches(1);
    DaylightTransport once(room, patches, nullptr, 1), twice(room, patches, nullptr, 1);
    const SurfacePoint sensor{{1.5, 2, 0.8}, {0, 0, 1}, RegionId()};
    SensorRays rays_of_once, rays_of_twice;
    once.make_elements(300), twice.make_elements(300);
    twice.cast_rows(16), twice.cast_sensor(sensor, 3, 64, rays_of_twice);
    for (DaylightTransport* const transport : {&once, &twice}) transport->cast_rows(128);
    once.cast_sensor(sensor, 3, 512, rays_of_once), twice.cast_sensor(sensor, 3, 512, rays_of_twice);
    const SkyColumns columns = SkyColumns::of_patches(patches.size());
    const ElementLight light_of_once = once.solve(columns), light_of_twice = twice.solve(columns);
    for (std::size_t k = 0; k < daylight_replicates; ++k) {
        EXPECT_EQ(light_of_once.reflected[k], light_of_twice.reflected[k]) << k;
        std::vector<float> row(patches.size()), other(patches.size());
        light_of_once.gather(k, rays_of_once[k], row), light_of_twice.gather(k, rays_of_twice[k], other);
        EXPECT_EQ(row, other) << k;
    }
}

TEST(Daylight, ASmallerRequestedErrorIsReached) {
    const Scene room = scene(true);
    DaylightTask task = task_of(desk_sensors(), {{"", 24}});
    task.site = {.place = {47.4, 8.5, 400}}, task.division = 2;
    Progress progress;
    for (const double requested : {0.2, has_address_sanitizer ? 0.05 : 0.01}) {
        task.error = requested;
        const Result<DaylightResults> results = collect_year(room, task, progress, StopRequest());
        ASSERT_TRUE(results);
        EXPECT_LE(results->summary.errors[0].factor, requested);
        EXPECT_GT(results->summary.errors[0].factor, 0);
    }
}

TEST(Daylight, BlocksFollowEachOtherAndGiveAllSensors) {
    // 300 sensors fill more than one block.
    const Scene room = scene(true);
    std::vector<ProbePoint> sensors;
    for (int i = 0; i < 300; ++i) sensors.push_back({{0.1 + 0.009 * i, 0.5 + 0.01 * i, 0.8}, {0, 0, 1}});
    DaylightTask task = task_of(sensors, {{"", 300}});
    task.site = {.place = {47.4, 8.5, 400}}, task.error = 0.2;
    Progress progress;
    const Result<DaylightResults> all = collect_year(room, task, progress, StopRequest());
    ASSERT_TRUE(all);
    std::size_t seen = 0;
    const auto compare = [&](const DaylightBlock& block) -> Result<void> {
        EXPECT_EQ(block.first, seen);
        for (std::size_t i = 0; i < block.results.size(); ++i, ++seen)
            for (std::size_t h = 0; h < task.hours.size(); ++h)
                EXPECT_EQ(block.illuminance[i * task.hours.size() + h],
                          all->year.illuminance[h * task.sensors.size() + block.first + i]);
        return {};
    };
    const StopRequest stop;
    DaylightSimulation simulation(room, task, progress, stop);
    ASSERT_TRUE(simulation.find_light());
    ASSERT_TRUE(simulation.evaluate({0, sensors.size()}, compare));
    EXPECT_EQ(seen, task.sensors.size());
}

}  // namespace exitance
