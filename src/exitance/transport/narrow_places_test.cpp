#include "exitance/transport/narrow_places.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/random.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "support/built_scene.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// Area of narrow leaves, m^2, on a mesh of elements about `edge` metres wide.
double narrow_area(const Scene& scene, double edge) {
    const Stage stage(scene);
    const ElementTree tree = stage.make_elements({.edge = edge, .grading_levels = 0});
    const Field<ElementId, std::uint8_t> narrow = find_narrow_leaves(stage, tree);
    double out = 0;
    for (ElementId e : tree.leaves()) out += narrow[e] ? tree.area(e) : 0;
    return out;
}

TEST(NarrowPlaces, AreLeavesWiderThanTheirGap) {
    // Both sides of the gaps over the lamp (1 m x 0.5 m) and behind the board (1.8 m x 1 m), and between the boxes both
    // sides of the smaller one's face (0.7 m x 0.6 m). Elements that extend out of a gap count as a whole.
    const double in_gaps = 2 * (0.5 + 1.8 + 0.42);
    const double area = narrow_area(built_scene("gaps"), 0.25);
    EXPECT_GT(area, 0.9 * in_gaps);
    EXPECT_LT(area, 1.5 * in_gaps);
}

TEST(NarrowPlaces, DoNotExistInARoom) {
    EXPECT_EQ(narrow_area(box_scene(2, 1, 1.5, 0.5, 1), 0.5), 0);
    // Objects on the floor touch it, which is no gap.
    EXPECT_EQ(narrow_area(built_scene("bright"), 0.2), 0);
}

double light_in_gaps(const Scene& scene) {
    const Stage stage(scene);
    return share_of_light_in_gaps(stage, project_direct_light(stage, {.mesh = {0.5, 0}, .tolerance = 0.1}, {}));
}

/// Share of the reflected direct light that leaves surfaces of a material, from exact light at sample points.
double exact_share(const Scene& scene, const std::string& material) {
    const Stage stage(scene);
    DirectLight::Workspace scratch;
    double of_group = 0, all = 0;
    for (const auto& [region, patch] : stage.pieces) {
        constexpr std::uint32_t count = 16;
        const ScrambledSobol places(hash(static_cast<std::uint64_t>(Stream::mesh), region.value));
        for (std::uint32_t k = 0; k < count; ++k) {
            const Point x = patch.at(uniform_in_shape(patch.shape, places(k, 0), places(k, 1)));
            const Normal& n = scene.regions()[region].plane.n;
            const double light =
                mean(scene.material(region).reflectance * stage.direct.irradiance(x, n, region, scratch)) *
                patch.area() / count;
            all += light, of_group += scene.material(region).name == material ? light : 0;
        }
    }
    return of_group / all;
}

struct Unsmoothed {
    double share;  ///< Mean over all elements, by area.
    double width;  ///< Width of an element, metres.
};

/// On a mesh of elements about `edge` metres wide.
Unsmoothed unsmoothed(const Scene& scene, double edge) {
    const Stage stage(scene);
    const ElementTree tree = stage.make_elements({.edge = edge, .grading_levels = 0});
    const std::vector<ElementId> leaves = tree.leaves();
    const std::vector<float> shares = unsmoothed_shares(stage, tree, leaves, StopRequest());
    double sum = 0, area = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i)
        sum += tree.area(leaves[i]) * shares[i], area += tree.area(leaves[i]);
    return {sum / area, std::sqrt(tree.area(leaves[0]))};
}

TEST(UnsmoothedShares, FollowTheDistanceBetweenTwoPlates) {
    // Between plates 50 times as wide as their elements, a cosine-weighted ray meets the other plate at d / sqrt(u), u
    // uniform: the integral of (x K1(x))^2, x = 2 pi d / (h sqrt(u)).
    for (const double d : {0.001, 0.02, 0.05, 0.2}) {
        const std::vector<Point> low = {{0, 0, 0}, {5, 0, 0}, {5, 5, 0}, {0, 5, 0}};
        std::vector<Point> high(low.rbegin(), low.rend());
        for (Point& p : high) p.z = d;
        const auto [share, h] = unsmoothed(test::make({{low}, {high, 1}}), 0.1);
        double expected = 0;
        constexpr int steps = 10000;
        for (int i = 0; i < steps; ++i) {
            const double x = 2 * pi * d / (h * std::sqrt((i + 0.5) / steps));
            expected += std::pow(x * std::cyl_bessel_k(1, x), 2) / steps;
        }
        // 5,000 elements with 8 rays each, whose values are at most 1, and rays that leave at the border
        EXPECT_NEAR(share, expected, 0.01 + 0.03 * expected) << d;
    }
}

TEST(UnsmoothedShares, AreSmallInARoom) {
    EXPECT_LT(unsmoothed(box_scene(4, 5, 3, 0.5, 1), 0.25).share, 0.02);
}

TEST(NarrowPlaces, HoldMuchOfTheLightOfABlindAndNoneOfARoom) {
    // Slats have the ceiling's material. The gaps between them are narrower than most of their elements, except the
    // smallest elements at their edges, which reflect most of the light.
    const Scene scene = built_scene("blinds");
    const double blinds = light_in_gaps(scene), slats = exact_share(scene, "ceiling");
    EXPECT_GT(blinds, 0.25 * slats);
    EXPECT_LT(blinds, 1.05 * slats);
    EXPECT_GT(blinds, 0.2);
    EXPECT_EQ(light_in_gaps(box_scene(2, 1, 1.5, 0.5, 1)), 0);
}

}  // namespace
}  // namespace exitance
