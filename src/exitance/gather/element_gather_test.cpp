#include "exitance/gather/element_gather.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"
#include "support/built_scene.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A function on the elements of a scene, given by its values at their corners.
template <class Value>
ElementFunction on_elements(const Stage& stage, MeshSize mesh, const Value& value) {
    ElementFunction b;
    b.tree = stage.make_elements(mesh);
    b.first_value.resize(b.tree.size(), 0);
    for (ElementId e : b.tree.leaves()) {
        b.first_value[e] = static_cast<std::uint32_t>(b.values.size());
        for (int i = 0; i < b.tree.patch(e).corner_count(); ++i)
            b.add_value(Spectrum(value(b.tree.patch(e).corner(i))));
    }
    return b;
}

double wavy(const Point& p) {
    return 1 + 0.8 * std::sin(3 * p.x + 1) * std::cos(2 * p.y) + 0.5 * p.z;
}

/// Irradiance at a random point of about every fifth leaf.
std::vector<double> gathered(const Scene& scene, const ElementGather& gather, const ElementTree& tree, double share) {
    std::vector<double> out;
    ElementGather::Workspace workspace;
    for (ElementId e : tree.leaves()) {
        RandomStream random(1, Stream::mesh, e.value);
        if (random.uniform() > 0.2) continue;
        const double s = random.uniform(), t = random.uniform();
        const RegionId region = tree.region(e);
        out.push_back(gather(tree.patch(e).at(tree.uniform(e, s, t)), scene.regions()[region].plane.n, region, share,
                             workspace)[0]);
    }
    return out;
}

TEST(ElementGather, GathersEvenLightExactly) {
    const Scene scene = box_scene(2, 1, 1.5, 0.5, 1);
    const Stage stage(scene);
    const ElementFunction b = on_elements(stage, {0.3, 3}, [](const Point&) { return 2.0; });
    const ElementGather gather(stage, b);
    // Form factors of a closed room sum to 1; b is exact in single precision.
    for (double E : gathered(scene, gather, b.tree, 1e-3)) EXPECT_NEAR(E, 2, 1e-11);
}

TEST(ElementGather, GathersEvenLightExactlyFromRotatedCells) {
    // A tent with both gables closed: strips along the edges of the triangles are cells of three to five corners. It is
    // rotated, so that points are in the planes of corners only up to rounding.
    const auto turned = [](const Point& p) {
        const double c = std::cos(0.7), s = std::sin(0.7);
        const Point q = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
        return Point{q.x, c * q.y - s * q.z, s * q.y + c * q.z};
    };
    const Point a = turned({0, 0, 0}), b = turned({2, 0, 0}), c = turned({2, 1, 0}), d = turned({0, 1, 0}),
                near = turned({0, 0.5, 1}), far = turned({2, 0.5, 1});
    const Scene scene =
        test::make({{{a, b, c, d}}, {{a, d, near}}, {{a, near, far, b}}, {{d, c, far, near}}, {{b, far, c}}});
    const Stage stage(scene);
    ASSERT_TRUE(ElementGather::suits(stage));
    const ElementFunction even = on_elements(stage, {0.2, 3}, [](const Point&) { return 2.0; });
    const ElementGather gather(stage, even);
    for (double E : gathered(scene, gather, even.tree, 1e-3)) EXPECT_NEAR(E, 2, 1e-10);
}

TEST(ElementGather, HasAboutTheAllowedError) {
    const Scene scene = box_scene(2, 1, 1.5, 0.5, 1);
    const Stage stage(scene);
    const ElementFunction b = on_elements(stage, {0.2, 3}, wavy);
    const ElementGather gather(stage, b);
    const std::vector<double> exact = gathered(scene, gather, b.tree, 1e-7);
    for (double share : {1e-3, 1e-5}) {
        const std::vector<double> found = gathered(scene, gather, b.tree, share);
        double square = 0, mean = 0;
        for (std::size_t i = 0; i < exact.size(); ++i) {
            const double error = found[i] / exact[i] - 1;
            square += error * error / static_cast<double>(exact.size());
            mean += error / static_cast<double>(exact.size());
        }
        // Some dozens of elements, each with an independent error of up to `share`.
        EXPECT_LT(std::sqrt(square), 10 * share) << share;
        EXPECT_LT(std::abs(mean), share) << share;
    }
}

TEST(ElementGather, AgreesWithFinePartsOnTrianglesAndParallelograms) {
    // A tent of two triangles and two rectangles over the place; E by brute force from small parts.
    const Scene scene = test::make({{{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}},
                                    {{{0, 0, 0}, {0, 1, 0}, {0, 0.5, 1}}},
                                    {{{0, 0, 0}, {0, 0.5, 1}, {2, 0.5, 1}, {2, 0, 0}}}});
    const Stage stage(scene);
    ASSERT_TRUE(ElementGather::suits(stage));
    const ElementFunction b = on_elements(stage, {0.5, 0}, wavy);
    const ElementGather gather(stage, b);
    ElementGather::Workspace workspace;
    const Normal up = {0, 0, 1};
    for (const Point& x : {Point{0.3, 0.4, 0}, Point{1.7, 0.2, 0}, Point{0.02, 0.5, 0}}) {
        double exact = 0;
        constexpr int steps = 400;
        for (ElementId e : b.tree.leaves()) {
            const Patch& patch = b.tree.patch(e);
            if (std::abs(patch.normal().z) > 0.99) continue;
            const double area = patch.area() / (steps * steps) * (patch.is_triangle() ? 2 : 1);
            for (int i = 0; i < steps; ++i)
                for (int j = 0; j < steps; ++j) {
                    const Vec2 uv = {(i + 0.5) / steps, (j + 0.5) / steps};
                    const double over =
                        patch.is_triangle() ? i + j + 1 - steps : -1;  // parts along a triangle's long side
                    if (over > 0) continue;
                    const Vec3 d = patch.at(uv) - x;
                    const double K = d.z * -dot(patch.normal(), d) / (pi * squared_norm(d) * squared_norm(d));
                    exact += (over == 0 ? 0.5 : 1) * area * std::max(0.0, K) * b.at({e, uv})[0];
                }
        }
        // The error of the brute-force sum with 400 x 400 parts per element.
        EXPECT_NEAR(gather(x, up, scene.surfaces()[SurfaceId(0)].region, 1e-6, workspace)[0], exact, 1e-3 * exact);
    }
}

TEST(ElementGather, SuitsScenesWithNothingInside) {
    const Scene empty = box_scene(2, 1, 1, 0.5, 1), furnished = built_scene("cornell");
    EXPECT_TRUE(ElementGather::suits(Stage(empty)));
    EXPECT_FALSE(ElementGather::suits(Stage(furnished)));
}

}  // namespace
}  // namespace exitance
