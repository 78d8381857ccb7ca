#include "exitance/error/late_paths.hpp"

#include <gtest/gtest.h>

#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// A furnace of reflectance 1/2. Its delivered light is too large by `delta` everywhere; exact is E_ind = 1.
struct WrongFurnace {
    static constexpr double rho = 0.5, delta = 0.3;
    Scene scene = box_scene(2, 1, 1.5, rho, 1, 1);
    Stage stage{scene};
    ElementFunction delivered;
    PathTracer paths{stage};
    DirectCheck check{stage, paths, {}, LightAccuracy()};
    PointwiseLight b{[](RegionId, const Point&) { return Spectrum(rho * (1 + 1 + delta)); }};
    std::vector<ResidualSample> samples;

    WrongFurnace() {
        for (const auto& [region, patch] : stage.pieces) {
            const ElementId e = delivered.tree.add_root(region, patch);
            delivered.first_value.resize(delivered.tree.size(), 0);
            delivered.first_value[e] = static_cast<std::uint32_t>(delivered.values.size());
            for (int k = 0; k < patch.corner_count(); ++k) delivered.add_value(Spectrum(1 + delta));
            for (double u : {0.1, 0.3, 0.5, 0.7, 0.9}) {
                ResidualSample s;
                s.place = {e, {u, 1 - u}}, s.region = region, s.weight = patch.area(), s.leaf = 0;
                samples.push_back(s);
            }
        }
    }

    LateMisfit misfit(double late, std::uint64_t seed) const {
        const std::vector<Spectrum> told{Spectrum(late)};
        return LatePaths(stage, delivered, b, check, false).misfit(samples, told, seed, 1 << 18);
    }
};

// The error of irradiance is e = 1 - (1 + delta) = -delta everywhere; the part rho e of it arrives by way of other
// surfaces.
// error of the radiosity, W/m^2
constexpr double late_part = -WrongFurnace::rho * WrongFurnace::rho * WrongFurnace::delta;

TEST(LatePaths, FindErrorsThatArriveFromOtherSurfaces) {
    const WrongFurnace furnace;
    RandomStream random(7, Stream::certificate);
    const LatePaths paths(furnace.stage, furnace.delivered, furnace.b, furnace.check, false);
    const SurfacePoint x{{0.7, 0.4, 0}, {0, 0, 1}, RegionId(0)};
    double sum = 0;
    std::size_t rays = 0;
    constexpr int count = 4000;
    for (int k = 0; k < count; ++k)
        sum += mean(paths.sample(x, random.uniform(), random.uniform(), random, rays)) / count;
    // A path's value is -delta (1 - rho) times its number of vertices, which has a mean of rho / (1 - rho) = 1 and a
    // variance of 2. The mean of 4000 paths therefore has a standard error of 0.022 times rho delta.
    EXPECT_NEAR(sum, -furnace.rho * furnace.delta, 4 * 0.023 * furnace.rho * furnace.delta);
    EXPECT_GT(rays, 2u * count);
}

TEST(LatePaths, FindErrorsOfTheCoarseResponse) {
    const WrongFurnace furnace;
    int right = 0, wrong = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const LateMisfit none = furnace.misfit(late_part, seed);
        right += !none.is_significant();
        // A coarse response that lacks half of the light differs by that half.
        const LateMisfit half = furnace.misfit(0.5 * late_part, seed);
        wrong += half.is_significant();
        EXPECT_NEAR(std::sqrt(std::max(0.0, half.mean_square)), -0.5 * late_part, -0.25 * late_part);
    }
    EXPECT_GE(right, 38);  // products of noise exceed two standard errors in some 5% of cases, twice in 1 of 400
    EXPECT_EQ(wrong, 40);
}

}  // namespace
}  // namespace exitance
