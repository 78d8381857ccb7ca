#include "exitance/accuracy/accuracy.hpp"

#include <gtest/gtest.h>

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

TEST(Tightened, LeavesTheMethodAloneWhereTheLocalPassIsToBlame) {
    const Tightened finer = tightened(knobs, {.method = 0.003, .noise = 0.01, .interpolation = 0.03}, 0.02, {});
    EXPECT_FALSE(finer.method);
    EXPECT_EQ(finer.knobs.direct_tolerance, knobs.direct_tolerance);
    EXPECT_EQ(finer.knobs.solve_mesh.edge, knobs.solve_mesh.edge);
    EXPECT_LT(finer.knobs.gather_tolerance, 0.7 * knobs.gather_tolerance);
}

TEST(Tightened, AsksForMoreRaysOnlyWhereTheyAreTooFew) {
    const Tightened finer = tightened(knobs, {.method = 0.003, .noise = 0.002, .interpolation = 0.03}, 0.02, {});
    EXPECT_EQ(finer.knobs.gather_noise, knobs.gather_noise);
    EXPECT_LT(finer.knobs.gather_tolerance, knobs.gather_tolerance);
}

TEST(Tightened, LeavesTheLocalPassAloneWhereTheMethodIsToBlame) {
    const Tightened finer = tightened(knobs, {.method = 0.04, .noise = 0.005, .interpolation = 0.005}, 0.02, {});
    EXPECT_TRUE(finer.method);
    EXPECT_LT(finer.knobs.direct_tolerance, knobs.direct_tolerance);
    EXPECT_EQ(finer.knobs.gather_tolerance, knobs.gather_tolerance);
    EXPECT_EQ(finer.knobs.gather_noise, knobs.gather_noise);
}

TEST(Tightened, AlwaysTightensSomething) {
    EXPECT_TRUE(tightened(knobs, {.method = 0.001, .noise = 0.001, .interpolation = 0.001}, 0.02, {}).method);
}

TEST(Tightened, KeepsWhatTheUserSet) {
    const Tightened finer = tightened(knobs, {.method = 0.05}, 0.02, {.mesh_size = 0.5});
    EXPECT_EQ(finer.knobs.solve_mesh.edge, 0.5);
}

}  // namespace
}  // namespace exitance
