#include "exitance/error/texture_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/built_scene.hpp"
#include "support/sample_solution.hpp"

namespace exitance {
namespace {

/// A box in which the same light arrives everywhere, with an estimate of its error.
Solution evenly_lit(double estimate) {
    Solution out;
    out.scene = box_scene(1, 2, 1, 0.5, 1, 1);
    out.indirect = sample_function(out.scene, 1, 20);
    for (auto& value : out.indirect.values) value.fill(2);
    out.interpolant = out.indirect;
    out.direct_in_elements = true;
    out.statistics.converged = true;
    out.statistics.relative_error_estimate = out.statistics.relative_error_bound = estimate;
    return out;
}

// Material 0 covers floor and walls, 8 m^2 of 10; material 1 covers the ceiling.
const std::vector<Spectrum> deviation{Spectrum(0.1), Spectrum(0.0)};
const double expected = std::sqrt(0.8) * 0.1 / 0.5;  // sqrt(8 (0.1 E)^2 / 10) / (0.5 E)

TEST(TextureError, IsTheRmsDeviationOfReflectanceOverItsMean) {
    const Solution s = evenly_lit(0.01);
    EXPECT_NEAR(texture_error(s.scene, mean_light(s), deviation), expected, 1e-6 * expected);
    EXPECT_EQ(texture_error(s.scene, mean_light(s), {}), 0);
}

TEST(TextureError, IsAddedToTheEstimateInQuadratureAndReported) {
    Solution s = evenly_lit(0.01);
    add_texture_error(s, deviation, std::nullopt);
    EXPECT_NEAR(*s.statistics.relative_error_estimate, std::hypot(0.01, expected), 1e-6);
    EXPECT_NEAR(*s.statistics.relative_error_bound, std::hypot(0.01, expected), 1e-6);
    EXPECT_NEAR(s.statistics.figures["relative_error_textures"], expected, 1e-6);
    ASSERT_EQ(s.statistics.warnings.size(), 1u);
    EXPECT_TRUE(s.statistics.converged) << "no error was requested";
}

TEST(TextureError, TheOnlyBodyHasTheErrorOfTheScene) {
    Solution s = evenly_lit(0.01);
    s.statistics.bodies = {{.surfaces = 6, .area = 10, .mean = 1, .error = 0.01, .points = 100, .first = SurfaceId(0)}};
    s.statistics.relative_error_estimate_worst_body = 0.01;
    add_texture_error(s, deviation, std::nullopt);
    // The mean reflected radiosity of the body is 0.5 E = 1 W/m^2.
    EXPECT_NEAR(*s.statistics.bodies[0].error, std::hypot(0.01, expected), 1e-6);
    EXPECT_NEAR(*s.statistics.relative_error_estimate_worst_body, std::hypot(0.01, expected), 1e-6);
}

TEST(TextureError, ASolutionThatMissesTheRequestedErrorHasNotConverged) {
    Solution s = evenly_lit(0.01);
    add_texture_error(s, deviation, 0.1);
    EXPECT_FALSE(s.statistics.converged);
    Solution good = evenly_lit(0.01);
    add_texture_error(good, deviation, 0.5);
    EXPECT_TRUE(good.statistics.converged);
}

TEST(TextureError, WithoutDeviationOrEstimateNothingChanges) {
    Solution s = evenly_lit(0.01);
    add_texture_error(s, std::vector<Spectrum>(2), 0.02);
    EXPECT_EQ(*s.statistics.relative_error_estimate, 0.01);
    s.statistics.relative_error_estimate.reset();
    add_texture_error(s, deviation, 0.02);
    EXPECT_FALSE(s.statistics.relative_error_estimate);
    EXPECT_TRUE(s.statistics.warnings.empty());
}

}  // namespace
}  // namespace exitance
