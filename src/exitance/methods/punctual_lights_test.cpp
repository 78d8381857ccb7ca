// Point and parallel lights with every method, compared with path tracing and with other methods.
#include <gtest/gtest.h>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/methods/carried_light.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/reference/path_reference.hpp"
#include "support/built_scene.hpp"
#include "support/checked_scene.hpp"
#include "support/solved.hpp"

namespace exitance {
namespace {

/// A closed room of 3 x 2 x 2 m with a board, lit by a bulb and a spot light.
Scene room_with_bulb() {
    SceneDescription d;
    d.file = "bulb.glb";
    for (const double z : {0.0, 2.0}) d.points.insert(d.points.end(), {{0, 0, z}, {3, 0, z}, {3, 2, z}, {0, 2, z}});
    d.points.insert(d.points.end(), {{1, 0.5, 1}, {2, 0.5, 1}, {2, 1.5, 1}, {1, 1.5, 1}});
    d.materials = {{"wall", Spectrum(0.6), {}}};
    d.groups = {"room"};
    for (const auto& face : std::vector<std::vector<std::uint32_t>>{{0, 1, 2, 3},
                                                                    {4, 7, 6, 5},
                                                                    {0, 4, 5, 1},
                                                                    {1, 5, 6, 2},
                                                                    {2, 6, 7, 3},
                                                                    {3, 7, 4, 0},
                                                                    {8, 9, 10, 11},
                                                                    {8, 11, 10, 9}})
        d.faces.push_back({face, 0, 0, 0});
    PunctualLight bulb;
    bulb.position = {1.5, 0.4, 1.7}, bulb.intensity = Spectrum(20.0);
    PunctualLight spot = bulb;
    spot.kind = PunctualLight::Kind::spot, spot.position = {0.5, 1, 1.9}, spot.direction = {0.6, 0, -0.8};
    d.lights = {bulb, spot};
    return checked_scene(std::move(d));
}

}  // namespace

TEST(PunctualLights, AreNamedWhereAMethodCannotCarryThem) {
    SolveOptions carried;
    carried.classical.direct = ClassicalDirect::carried;
    const Result<void> fits = check_carried_light(room_with_bulb(), carried);
    ASSERT_FALSE(fits);
    EXPECT_NE(fits.error().message.find("light that no surface emits"), std::string::npos) << fits.error().message;
    EXPECT_EQ(fits.error().message.find("glass"), std::string::npos) << fits.error().message;
}

TEST(PunctualLights, AgreeWithPathsInAClosedRoom) {
    const Scene scene = room_with_bulb();
    const Solution solution = solved(scene, {.error = 0.03});
    EXPECT_LE(solution.statistics.relative_error_estimate, 0.03);
    std::vector<ProbePoint> points;
    for (int i = 0; i < 12; ++i) points.push_back({{0.1 + 0.25 * i, 0.9, 0}, {0, 0, 1}});
    for (int i = 0; i < 6; ++i) points.push_back({{3, 0.15 + 0.3 * i, 1.2}, {-1, 0, 0}});
    Progress progress;
    const StopRequest stop;
    const auto paths = reference_light(scene, points, 2048, 1, progress, stop);
    const auto light = RadiosityFunction(solution).at(points);
    double square = 0, noise = 0, mean_light = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        square += std::pow(light[i].irradiance[0] - paths[i].irradiance[0], 2);
        noise += std::pow(paths[i].standard_error[0], 2);
        mean_light += paths[i].irradiance[0];
    }
    const double n = static_cast<double>(points.size());
    // The requested error, and three times the noise of the paths' mean square.
    EXPECT_LT(std::sqrt(std::max(0.0, square - noise) / n),
              (0.03 + 3 * std::sqrt(noise / n) / (mean_light / n)) * mean_light / n);
}

TEST(PunctualLights, TheirPowerIsAbsorbedBySurfaces) {
    const Scene scene = room_with_bulb();
    const Solution solution = solved(scene, {.error = 0.05});
    Spectrum power;
    for (const PunctualLight& light : scene.lights()) power += light.power();
    EXPECT_NEAR(solution.statistics.energy.emitted, mean(power), 1e-9);
    EXPECT_LT(solution.statistics.energy.defect, 0.02);  // hard shadow edges cross elements
}

TEST(PunctualLights, AreLitByEveryMethod) {
    const Scene scene = room_with_bulb();
    const std::vector<ProbePoint> points = {
        {{1.5, 1, 0}, {0, 0, 1}}, {{0.2, 1, 0}, {0, 0, 1}}, {{3, 1, 1}, {-1, 0, 0}}};
    const Solution matrix = solved(scene, {.error = 0.02});
    const auto expected = RadiosityFunction(matrix).at(points);
    for (const Method method : {Method::progressive, Method::monte_carlo}) {
        const Solution solution =
            solved(scene, {.method = method, .error = 0.1, .visibility = VisibilityKind::fractional});
        const auto light = RadiosityFunction(solution).at(points);
        for (std::size_t i = 0; i < points.size(); ++i)
            EXPECT_NEAR(light[i].irradiance[0], expected[i].irradiance[0], 0.15 * expected[i].irradiance[0]) << i;
    }
}

}  // namespace exitance
