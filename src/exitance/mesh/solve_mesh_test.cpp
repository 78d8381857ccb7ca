#include "exitance/mesh/solve_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/mesh/adaptive.hpp"
#include "exitance/transport/stage.hpp"
#include "support/built_scene.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

TEST(SolveMesh, IsIndependentOfOrientationIfLengthsAreMultiplesOfTheEdge) {
    const Scene table = built_scene("table");
    const std::vector<Piece> pieces = Stage(table).pieces;
    const auto leaves = [](const Scene& scene, double edge) {
        const Stage stage(scene);
        return make_mesh(stage.pieces, stage.concave, {.edge = edge, .grading_levels = 2}).leaves().size();
    };
    const std::size_t as_it_is = leaves(table, 0.4);
    const std::size_t predicted = predict_elements(pieces, 0.4);
    for (const char* rot : {"31.7,0.3,0.5,1", "90,0,0,1", "211,-2,0.1,0.7"})
        for (const auto& more : {std::pair("shift", "1000,370,-210"), {"shift", "0,0,0"}}) {
            const Scene scene = built_scene("table", {{"rot", rot}, more});
            EXPECT_EQ(leaves(scene, 0.4), as_it_is) << rot << " " << more.second;
            EXPECT_EQ(predict_elements(Stage(scene).pieces, 0.4), predicted) << rot << " " << more.second;
        }
    EXPECT_EQ(leaves(built_scene("table", {{"rot", "31.7,0.3,0.5,1"}, {"scale", "0.001"}}), 0.0004), as_it_is);
}

/// Width of the narrowest leaf of the lower of two squares of 1 m that meet at the line x = 0 and fold by an angle, 0
/// for squares in a plane. `triangles`: both squares are halved.
double narrowest_at_fold(double degrees, bool triangles) {
    const double c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
    const Point a{0, 0, 0}, b{0, 1, 0}, low_a{-1, 0, 0}, low_b{-1, 1, 0}, high_a{c, 0, s}, high_b{c, 1, s};
    std::vector<test::Face> faces;
    const auto add = [&](const Point& p, const Point& q, const Point& r, const Point& t) {
        if (!triangles) return faces.push_back({{p, q, r, t}, 1});
        faces.push_back({{p, q, r}, 1});
        faces.push_back({{p, r, t}, 1});
    };
    add(low_a, a, b, low_b);
    add(a, high_a, high_b, b);
    const Scene scene = test::make(faces);
    const Stage stage(scene);
    const ElementTree tree = make_mesh(stage.pieces, stage.concave, {.edge = 0.5, .grading_levels = 4});
    double narrowest = 1;
    for (const ElementId e : tree.leaves()) {
        double farthest = 0;
        bool is_lower = true, touches = false;
        for (const Point& p : tree.outline(e)) {
            is_lower = is_lower && p.x <= 1e-9 && std::abs(p.z) < 1e-9;
            touches = touches || std::abs(p.x) < 1e-9;
            farthest = std::max(farthest, -p.x);
        }
        if (is_lower && touches) narrowest = std::min(narrowest, farthest);
    }
    return narrowest;
}

TEST(SolveMesh, StripsAlongAFoldFollowTheLightThatItsSidesExchange) {
    // Next to a fold, light varies by 1 - cos(angle), and a strip of the width w leaves an error in proportion to
    // w^1.2.
    const double at_right_angle = 0.5 / 16;
    for (const bool triangles : {false, true}) {
        EXPECT_NEAR(narrowest_at_fold(90, triangles), at_right_angle, 1e-9);
        EXPECT_NEAR(narrowest_at_fold(135, triangles), at_right_angle, 1e-9);
        const double at_45 = at_right_angle * std::pow(1 - std::cos(pi / 4), -1 / 1.2);
        // Parallelograms are halved until they are no wider; triangles are cut at the width itself.
        EXPECT_NEAR(narrowest_at_fold(45, triangles), triangles ? at_45 : 0.5 / 8, 1e-6);
        EXPECT_GE(narrowest_at_fold(10, triangles), 0.25 - 1e-9) << "no strips on smooth bodies";
    }
}

TEST(RefineElement, SplitsAThreeToTwoParallelogramTheSameInEveryOrientation) {
    const double rounding = 1e-12;
    for (const double length : {3 - rounding, 3.0, 3 + rounding}) {
        ElementTree tree;
        const ElementId root =
            tree.add_root(RegionId(0u), {{0, 0, 0}, {length, 0, 0}, {0, 2, 0}, Patch::Shape::parallelogram});
        EXPECT_EQ(refine_element(tree, root).size(), 4u) << length - 3;
    }
}

}  // namespace
}  // namespace exitance
