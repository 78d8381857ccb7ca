#include "exitance/error/tolerance/accuracy.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace exitance {
namespace {

const Knobs knobs = [] {
    Knobs k;
    k.solve_mesh = {0.5, 2};
    k.solve_rays = {.average = 64};
    k.direct_tolerance = 0.05;
    k.gather_tolerance = k.gather_noise = 0.01;
    return k;
}();

/// Checks that settings change little when the error does, and only towards more work as the error decreases.
void expect_continuous(bool sums) {
    LitSpaces lit;
    for (int i = 0; i < 12; ++i)
        lit.pieces.push_back(
            {RegionId(0), Patch{{0, 0, 0}, {1 + 0.37 * i, 0, 0}, {0, 3 - 0.17 * i, 0}, Patch::Shape::parallelogram}});
    const auto of = [&](double error) {
        const Knobs plain = knobs_for_error(error, lit, {});
        return sums ? knobs_for_sums(plain, error, lit, {}) : plain;
    };
    constexpr double step = 0.99;
    Knobs last = of(0.1);
    for (double error = step * 0.1; error > 0.002; error *= step) {
        const Knobs now = of(error);
        const auto near = [&](double before, double after, double factor) {
            EXPECT_LT(std::abs(std::log(after / before)), std::log(factor)) << "at " << error;
        };
        near(last.solve_mesh.edge, now.solve_mesh.edge, 1.2);
        near(last.gather_mesh.edge, now.gather_mesh.edge, sums || (error > 0.0295 && error < 0.0305) ? 2.5 : 1.2);
        near(last.solve_rays.average, now.solve_rays.average, 1.05);
        near(last.direct_tolerance, now.direct_tolerance, 1.05);
        near(last.gather_noise, now.gather_noise, 1.05);
        EXPECT_LE(now.solve_mesh.grading_levels, last.solve_mesh.grading_levels + 1) << "at " << error;
        EXPECT_GE(now.solve_mesh.grading_levels, last.solve_mesh.grading_levels) << "at " << error;
        EXPECT_GE(now.gather_mesh.grading_levels, last.gather_mesh.grading_levels) << "at " << error;
        last = now;
    }
}

TEST(Knobs, AreContinuousInTheError) {
    expect_continuous(false);
}

TEST(Knobs, OfSumsAreContinuousInTheError) {
    expect_continuous(true);
}

TEST(Tightened, KeepsTheMethodIfTheLocalPassIsInaccurate) {
    const Tightened finer = tightened(knobs, {.method = 0.003, .noise = 0.01, .interpolation = 0.03}, 0.02, {});
    EXPECT_FALSE(finer.method);
    EXPECT_EQ(finer.knobs.direct_tolerance, knobs.direct_tolerance);
    EXPECT_EQ(finer.knobs.solve_mesh.edge, knobs.solve_mesh.edge);
    EXPECT_LT(finer.knobs.gather_tolerance, 0.7 * knobs.gather_tolerance);
}

TEST(Tightened, AddsRaysOnlyIfNoiseIsTooLarge) {
    const Tightened finer = tightened(knobs, {.method = 0.003, .noise = 0.002, .interpolation = 0.03}, 0.02, {});
    EXPECT_EQ(finer.knobs.gather_noise, knobs.gather_noise);
    EXPECT_LT(finer.knobs.gather_tolerance, knobs.gather_tolerance);
}

TEST(Tightened, KeepsTheLocalPassIfTheMethodIsInaccurate) {
    const Tightened finer = tightened(knobs, {.method = 0.04, .noise = 0.005, .interpolation = 0.005}, 0.02, {});
    EXPECT_TRUE(finer.method);
    EXPECT_LT(finer.knobs.direct_tolerance, knobs.direct_tolerance);
    EXPECT_EQ(finer.knobs.gather_tolerance, knobs.gather_tolerance);
    EXPECT_EQ(finer.knobs.gather_noise, knobs.gather_noise);
}

TEST(Tightened, AlwaysTightensSomething) {
    EXPECT_TRUE(tightened(knobs, {.method = 0.001, .noise = 0.001, .interpolation = 0.001}, 0.02, {}).method);
}

TEST(Refined, KeepsTheLocalPassIfAStepIsEnough) {
    const ErrorParts parts{.method = 0.03, .noise = 0.01, .interpolation = 0.005};
    const Tightened enough = tightened_for_step(knobs, parts, 0.3, 0.02, 0.014, {});
    EXPECT_EQ(enough.knobs.gather_noise, knobs.gather_noise);
    EXPECT_EQ(enough.knobs.gather_tolerance, knobs.gather_tolerance);
    EXPECT_EQ(enough.knobs.solve_mesh.edge, knobs.solve_mesh.edge);
    EXPECT_EQ(enough.work, 1);
    const Tightened too_little = tightened_for_step(knobs, {.method = 0.03, .noise = 0.02}, 0.3, 0.02, 0.014, {});
    EXPECT_LT(too_little.knobs.gather_noise, knobs.gather_noise);
    EXPECT_EQ(too_little.knobs.gather_tolerance, knobs.gather_tolerance);
    EXPECT_EQ(too_little.knobs.solve_rays.average, knobs.solve_rays.average);
}

TEST(Tightened, KeepsSettingsOfTheUser) {
    const Tightened finer = tightened(knobs, {.method = 0.05}, 0.02, {.mesh_size = 0.5});
    EXPECT_EQ(finer.knobs.solve_mesh.edge, 0.5);
}

TEST(Accuracy, ManyRoomsGetElementsInProportion) {
    LitSpaces lit;
    for (int i = 0; i < 40; ++i)
        lit.pieces.push_back({RegionId(0), Patch{{0, 0, 0}, {4, 0, 0}, {0, 3, 0}, Patch::Shape::parallelogram}});
    const auto elements = [&](double multiplicity, bool gather) {
        lit.multiplicity = multiplicity;
        const Knobs found = knobs_for_error(0.01, lit, {});
        return static_cast<double>(
            predict_elements(lit.pieces, gather ? found.gather_mesh.edge : found.solve_mesh.edge));
    };
    // an edge is found in steps that change the number of elements by up to a factor of 2
    for (const bool gather : {false, true}) {
        const double ratio = elements(16, gather) / elements(1, gather);
        EXPECT_TRUE(ratio >= 8 && ratio <= 32) << ratio;
    }
}

}  // namespace
}  // namespace exitance
