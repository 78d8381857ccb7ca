#include "exitance/error/late_paths.hpp"

#include <gtest/gtest.h>

#include "support/wrong_furnace.hpp"

namespace exitance {
namespace {

constexpr double late_part = WrongFurnace::late_part;

LateMisfit misfit(const WrongFurnace& furnace, double late, std::uint64_t seed) {
    const std::vector<Spectrum> response{Spectrum(late)};
    return furnace.late_paths().misfit(furnace.samples, response, seed, 1 << 18);
}

TEST(LatePaths, FindErrorsThatArriveFromOtherSurfaces) {
    const WrongFurnace furnace;
    RandomStream random(7, Stream::certificate);
    const LatePaths paths = furnace.late_paths();
    LatePaths::Workspace workspace;
    const SurfacePoint x{{0.7, 0.4, 0}, {0, 0, 1}, RegionId(0)};
    double sum = 0;
    std::size_t rays = 0;
    constexpr int count = 4000;
    for (int k = 0; k < count; ++k)
        sum += mean(paths.sample(x, random.uniform(), random.uniform(), random, workspace, rays)) / count;
    // A path's value is -delta (1 - rho) times its number of vertices, which has a mean of rho / (1 - rho) = 1 and a
    // variance of 2. The mean of 4000 paths therefore has a standard error of 0.022 times rho delta.
    EXPECT_NEAR(sum, -furnace.rho * furnace.delta, 4 * 0.023 * furnace.rho * furnace.delta);
    EXPECT_GT(rays, 2u * count);
}

TEST(LatePaths, FindErrorsOfTheCoarseResponse) {
    const WrongFurnace furnace;
    int right = 0, wrong = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const LateMisfit none = misfit(furnace, late_part, seed);
        right += !none.is_significant();
        if (seed > 10) continue;
        // A coarse response that lacks half of the light differs by that half.
        const LateMisfit half = misfit(furnace, 0.5 * late_part, seed);
        wrong += half.is_significant();
        EXPECT_NEAR(std::sqrt(std::max(0.0, half.mean_square)), -0.5 * late_part, -0.25 * late_part);
    }
    EXPECT_GE(right, 38);  // products of noise exceed two standard errors in some 5% of cases, twice in 1 of 400
    EXPECT_EQ(wrong, 10);
}

}  // namespace
}  // namespace exitance
