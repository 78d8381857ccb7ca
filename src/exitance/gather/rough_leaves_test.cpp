#include <gtest/gtest.h>

#include "exitance/base/random.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/gather/local_pass.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A box whose ceiling sends light, b = 1 W/m^2, and a plate 16 mm above its floor. The floor is dark below the plate.
/// At 50 mm from the plate's edge, the plate hides only directions within 18 degrees of the floor, which bring under a
/// twentieth of the ceiling's light.
struct PlateOnFloor {
    static constexpr double low = 0.45, high = 1.55, near_side = 0.35, far_side = 1.15;  ///< Borders of the plate, m.

    static Scene scene_of() {
        std::vector<test::Face> faces = test::closed_box({}, {2, 1.5, 1});
        const auto at = [](double x, double y, double z) { return Point{x, y, z}; };
        for (const double z : {0.016, 0.017})
            faces.push_back(
                {{at(low, near_side, z), at(high, near_side, z), at(high, far_side, z), at(low, far_side, z)}});
        std::swap(faces[6].corners[1], faces[6].corners[3]);  // turn the lower face downwards
        return test::make(faces);
    }
    Scene scene = scene_of();
    Stage stage{scene};
    RegionId floor = scene.surfaces()[SurfaceId(0)].region, ceiling = scene.surfaces()[SurfaceId(1)].region;
    PointwiseLight b{[this](RegionId region, const Point&) { return Spectrum(region == ceiling ? 1.0 : 0.0); }};

    /// RMS error of E on a strip of the floor, 50 to 70 mm from one border of the plate, relative to E.
    double error_beside(const ElementFunction& E, int border) const {
        const ElementLocator locator(E.tree, scene.regions().size());
        RandomStream random(1, Stream::mesh, static_cast<std::uint64_t>(border));
        constexpr int count = 400;
        double square = 0, light = 0;
        for (int k = 0; k < count; ++k) {
            const double away = 0.05 + 0.02 * random.uniform(), t = random.uniform();
            const double x = border == 0 ? low - away : border == 1 ? high + away : low + t * (high - low);
            const double y = border == 2   ? near_side - away
                             : border == 3 ? far_side + away
                                           : near_side + t * (far_side - near_side);
            const double exact = point_to_polygon({x, y, 0}, {0, 0, 1}, scene.outline(SurfaceId(1)));
            square += std::pow(E.at(locator.find(floor, {x, y, 0}))[0] - exact, 2), light += exact * exact;
        }
        return std::sqrt(square / light);
    }
};

TEST(RoughPlaces, AreFollowedAlongAllOfAShadow) {
    const PlateOnFloor plate;
    // The mesh is so coarse, and so little light is required, that no node meets the border of the shadow.
    LocalPass pass(plate.stage, {.edge = 0.25, .grading_levels = 0}, 1);
    LocalPassDemand demand{.rays = {.average = 64}, .noise = 0.005, .tolerance = 0.01, .max_depth = 0};
    Progress progress;
    const StopRequest stop;
    LocalPassReport report;
    const ElementFunction before = pass.gather(plate.b, true, demand, report, progress, stop);
    // One rough point on one side of the shadow is enough to find all four sides.
    const std::vector<RoughPlace> found{{plate.floor, {1, PlateOnFloor::far_side + 0.003, 0}}};
    demand.max_depth = 8, demand.rough_places = found;
    const ElementFunction after = pass.gather(plate.b, false, demand, report, progress, stop);
    for (int border = 0; border < 4; ++border) {
        EXPECT_GT(plate.error_beside(before, border), 0.15) << border;
        EXPECT_LT(plate.error_beside(after, border), 0.6 * plate.error_beside(before, border)) << border;
    }
    // Only elements at the border of the shadow are refined.
    EXPECT_LT(after.tree.leaves().size(), 4 * before.tree.leaves().size());
}

TEST(RoughPlaces, CostNothingWhereLightIsSmooth) {
    const PlateOnFloor plate;
    LocalPass pass(plate.stage, {.edge = 0.25, .grading_levels = 0}, 1);
    LocalPassDemand demand{.rays = {.average = 64}, .noise = 0.005, .tolerance = 0.03};
    Progress progress;
    const StopRequest stop;
    LocalPassReport first, again;
    const ElementFunction before = pass.gather(plate.b, true, demand, first, progress, stop);
    const RegionId wall = plate.scene.surfaces()[SurfaceId(2)].region;
    const std::vector<RoughPlace> found{{wall, {1, 0, 0.6}}};
    demand.rough_places = found;
    const ElementFunction after = pass.gather(plate.b, false, demand, again, progress, stop);
    EXPECT_EQ(before.values, after.values);
    EXPECT_LE(again.rays, 4096u);  // the place is examined once, and nothing is refined
}

}  // namespace
}  // namespace exitance
