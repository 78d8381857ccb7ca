#include "exitance/error/direct_check.hpp"

#include <gtest/gtest.h>

#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// A closed box with a lamp as its ceiling. The projection of direct light is exact, but claims a large misfit on the
/// floor.
struct DoubtedFloor {
    static constexpr RegionId floor{0}, ceiling{1};
    Scene scene = box_scene(1, 1, 1, 0.5, 1);
    Stage stage{scene};
    PathTracer paths{stage};
    PointwiseLight direct{[this](RegionId region, const Point& y) {
        PlaceLight::Workspace workspace;
        return stage.place_light.at(y, scene.regions()[region].plane.n, region, LightAccuracy(), workspace).irradiance;
    }};
    ProjectedDirect projected{&direct, Spectrum(1.0),
                              [](const RayEnd& hit) { return hit.region == floor ? 1e3 : 0.0; }};
    DirectCheck check{stage, paths, projected, LightAccuracy()};

    /// Returns places on the floor, which sees no floor, and as many on the ceiling.
    std::vector<PilotPlace> places(double rays_on_ceiling, double weight_on_ceiling) const {
        std::vector<PilotPlace> out;
        for (int i = 0; i < 16; ++i)
            for (int k = 0; k < 16; ++k) {
                const double x = (i + 0.5) / 16, y = (k + 0.5) / 16;
                out.push_back({{{x, y, 0}, floor}, (1 - weight_on_ceiling) / 256, 1});
                out.push_back({{{x, y, 1}, ceiling}, weight_on_ceiling / 256, rays_on_ceiling});
            }
        return out;
    }
};

// Places of little weight may have most of the rays, as in gaps and in corners of furniture. Their checks take time all
// the same.
TEST(CheckPlan, WorkCountsRaysNotWeights) {
    const DoubtedFloor room;
    PlaceLight::Workspace workspace;
    const RayEnd hit{{0.4, 0.3, 0}, DoubtedFloor::floor};
    const double work = room.check.exact_difference(hit, Spectrum(), 0, workspace).work;
    // The form factor between opposite faces of a cube. Each of these hits is checked, since its misfit is large.
    constexpr double share_of_hits = 0.1998;
    // With 256 places of 8 rays, the share of hits has a standard error of at most sqrt(0.2 x 0.8 / 2048), 4.4%.
    constexpr double tolerance = 3 * 0.044;
    for (const double rays : {1.0, 9.0, 99.0}) {
        const CheckPlan plan =
            plan_check(room.check, room.stage, room.direct, room.places(rays, 0.01), 5, {.tolerated = 1e-3});
        ASSERT_TRUE(plan.is_exact);
        const double expected = rays / (1 + rays) * share_of_hits * work;
        EXPECT_NEAR(plan.work, expected, tolerance * expected) << rays;
    }
}

// A certificate passes the weights of a few of its places, whose sum is far below 1.
TEST(CheckPlan, DoesNotDependOnTheSumOfWeights) {
    const DoubtedFloor room;
    const std::vector<PilotPlace> places = room.places(1, 0.5);
    std::vector<PilotPlace> few_of_many = places;
    for (PilotPlace& place : few_of_many) place.weight /= 64;
    const auto plan_at = [&](std::span<const PilotPlace> at) {
        return plan_check(room.check, room.stage, room.direct, at, 5, {.tolerated = 1e-3});
    };
    const CheckPlan all = plan_at(places), few = plan_at(few_of_many);
    EXPECT_EQ(few.is_exact, all.is_exact);
    EXPECT_DOUBLE_EQ(few.per_misfit, all.per_misfit);
    EXPECT_NEAR(few.variance, all.variance, 1e-12 * all.variance);
    EXPECT_NEAR(few.gather_variance, all.gather_variance, 1e-12 * all.gather_variance);
}

}  // namespace
}  // namespace exitance
