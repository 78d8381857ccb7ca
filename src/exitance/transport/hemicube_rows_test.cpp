#include "exitance/transport/hemicube_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exitance/base/parallel.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "support/built_scene.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

struct Rows {
    Scene scene;
    Stage stage;
    ElementTree tree;
    LeafNumbering numbering;
    ElementLocator locator;
    HemicubeRows F;

    Rows(Scene of, double edge, unsigned cells)
        : scene(std::move(of)),
          stage(scene),
          tree(stage.make_elements({edge, 0})),
          numbering(tree),
          locator(tree, scene.regions().size()),
          F(stage, {tree, numbering, locator}, cells) {}

    /// Form factor from the receiver's centre, without occlusion.
    double exact(std::size_t receiver, std::size_t source) const {
        const ElementId p = numbering.leaves[receiver];
        return point_to_polygon(tree.patch(p).at(tree.centre(p)), stage.scene.regions()[tree.region(p)].plane.n,
                                tree.outline(numbering.leaves[source]));
    }
};

/// A floor of 1 m x 1 m, and a square of side `size` 1 m above it, moved diagonally by `offset` from the centre, m.
Scene small_square(double size, double offset) {
    const double lo = 0.5 - size / 2 + offset, hi = lo + size;
    return test::make(
        {{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, {{{lo, lo, 1}, {lo, hi, 1}, {hi, hi, 1}, {hi, lo, 1}}}});
}

}  // namespace

TEST(Hemicube, HasFormFactorsThatSumToOne) {
    for (const unsigned cells : {2u, 16u, 50u}) {
        const Hemicube cube(cells);
        EXPECT_EQ(cube.factor.size(), 3 * cells * cells);
        EXPECT_NEAR(std::accumulate(cube.factor.begin(), cube.factor.end(), 0.0), 1, 1e-12);
        for (std::size_t k = 0; k < cube.factor.size(); ++k) EXPECT_GT(cube.direction[k].z, 0);
    }
}

TEST(Hemicube, HasTheDeltaFormFactorsOfThePaper) {
    const unsigned cells = 100;
    const Hemicube cube(cells);
    const double area = 4.0 / cells / cells;
    for (std::size_t k = 0; k < cube.factor.size(); ++k) {
        const Vec3& d = cube.direction[k];
        const double rr = squared_norm(d);
        // 1 / (pi (x^2 + y^2 + 1)^2) on top, z / (pi (y^2 + z^2 + 1)^2) on the sides. The paper evaluates them at the
        // centre of the cell, so that they differ for cells of finite size.
        EXPECT_NEAR(cube.factor[k], d.z * area / (pi * rr * rr), 3e-4 * area) << k;
    }
}

TEST(Hemicube, IsAlignedIndependentlyOfTheOrderOfCorners) {
    const Frame plane(normalized(Vec3{1, 2, 3}));
    const auto on_plane = [&](double x, double y) { return Point{7, -5, 2} + plane.to_world(x, y, 0); };
    const Point corners[] = {on_plane(0, 0), on_plane(3, 0.4), on_plane(1, 2)};
    const auto triangle = [&](int k) {
        const Point &p = corners[k % 3], &q = corners[(k + 1) % 3], &r = corners[(k + 2) % 3];
        return Patch{p, q - p, r - p, Patch::Shape::triangle};
    };
    const auto parallelogram = [&](bool other) {
        const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[0];
        return other ? Patch{corners[1], b, -a} : Patch{corners[0], a, b};
    };
    const auto aligned = [&](const Patch& one, const Patch& other) {
        return std::abs(dot(hemicube_axis(one, plane.n), hemicube_axis(other, plane.n)));
    };
    for (int k : {1, 2}) EXPECT_NEAR(aligned(triangle(0), triangle(k)), 1, 1e-12);
    EXPECT_NEAR(aligned(parallelogram(false), parallelogram(true)), 1, 1e-12);
    // A hemicube that is turned by 90 degrees is the same.
    const Patch square{{}, {1, 0, 0}, {0, 1, 0}}, rectangle{{}, {1, 0, 0}, {0, 2, 0}};
    for (const Patch& patch : {square, rectangle}) {
        const Normal axis = hemicube_axis(patch, {0, 0, 1});
        EXPECT_NEAR(std::max(std::abs(axis.x), std::abs(axis.y)), 1, 1e-12);
    }
}

TEST(HemicubeRows, SumToOneInAClosedScene) {
    // A room with a block that floats in it. Edges of the block do not coincide with any ray, which could then hit a
    // back.
    std::vector<test::Face> faces = test::closed_box({0, 0, 0}, {3, 2, 2});
    for (test::Face block : test::closed_box({1.137, 0.713, 0.541}, {0.83, 0.52, 0.91})) {
        std::reverse(block.corners.begin(), block.corners.end());
        faces.push_back(block);
    }
    const Rows rows(test::make(faces), 0.5, 16);
    const std::vector<Spectrum> ones(rows.F.size(), Spectrum(1.0));
    for (std::size_t i = 0; i < rows.F.size(); ++i)
        EXPECT_NEAR(rows.F.gather_at(i, ones)[0], 1, 1e-6);  // entries are floats
}

TEST(HemicubeRows, ConvergeToExactFormFactors) {
    const Scene box = box_scene(1, 2, 3, 0.8, 1);
    std::vector<double> error;
    for (const unsigned cells : {16u, 64u, 256u}) {
        const Rows rows(box, 1, cells);
        double sum = 0, all = 0;
        for (std::size_t i = 0; i < rows.F.size(); ++i)
            for (std::size_t j = 0; j < rows.F.size(); ++j) {
                sum += std::pow(rows.F.form_factor(i, j) - rows.exact(i, j), 2);
                all += std::pow(rows.exact(i, j), 2);
            }
        error.push_back(std::sqrt(sum / all));
    }
    // Whole cells along each outline belong to one element or the other: O(1 / N), with random variation.
    EXPECT_LT(error[1], error[0] / 2.5) << error[0];
    EXPECT_LT(error[2], error[1] / 2.5) << error[1];
    EXPECT_LT(error[2], 0.01);
}

TEST(HemicubeRows, MissASourceSmallerThanACellOrCountAWholeCell) {
    // Rays to the ceiling are 2 / 16 m apart. A square of 2 cm lies between them, or is hit by one.
    const Rows missed(small_square(0.02, 0), 2, 16), met(small_square(0.02, 1.0 / 16), 2, 16);
    EXPECT_EQ(missed.F.form_factor(0, 1), 0);
    EXPECT_GT(met.F.form_factor(0, 1), 20 * met.exact(0, 1));
}

TEST(HemicubeRows, AreTheSameOnAnyNumberOfThreads) {
    const Scene scene = built_scene("cornell");
    std::vector<double> before;
    for (const int count : {1, 2}) {
        set_threads(count);
        const Rows rows(scene, 0.5, 16);
        std::vector<double> now;
        for (std::size_t i = 0; i < rows.F.size(); ++i)
            for (std::size_t j = 0; j < rows.F.size(); ++j) now.push_back(rows.F.form_factor(i, j));
        if (count > 1) {
            EXPECT_EQ(now, before);
        }
        before = now;
    }
    set_threads(0);
}

}  // namespace exitance
