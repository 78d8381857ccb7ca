#include "exitance/mesh/planar_subdivision.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace exitance {
namespace {

using Loops = std::vector<std::vector<Vec2>>;
const Loops square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

double area(const LabelledTriangles& t) {
    double sum = 0;
    for (const auto& c : t.corners)
        sum += 0.5 * cross(t.points[c[1]] - t.points[c[0]], t.points[c[2]] - t.points[c[0]]);
    return sum;
}

double labelled_length(const LabelledTriangles& t, std::uint8_t label) {
    double sum = 0;
    for (std::size_t i = 0; i < t.corners.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2 d = t.points[t.corners[i][(k + 1) % 3]] - t.points[t.corners[i][k]];
            if (t.labels[i][k] == label) sum += std::sqrt(dot(d, d));
        }
    return sum;
}

/// Smallest angle, radians.
double min_angle(const LabelledTriangles& t) {
    double least = std::numbers::pi;
    for (const auto& c : t.corners)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2 a = t.points[c[(k + 1) % 3]] - t.points[c[k]], b = t.points[c[(k + 2) % 3]] - t.points[c[k]];
            least = std::min(least, std::atan2(cross(a, b), dot(a, b)));
        }
    return least;
}

TEST(RefinedTriangles, HaveNoSmallAnglesIfTheLinesHaveNone) {
    const std::vector<LabelledSegment> lines{{{0.1, 0.2}, {0.15, 0.6}, 2}, {{0.7, 0.3}, {0.5, 0.35}, 3}};
    const LabelledTriangles coarse = labelled_triangles(square, lines), fine = refined_triangles(coarse);
    constexpr double bound = 20.7 * std::numbers::pi / 180;
    EXPECT_LT(min_angle(coarse), 0.8 * bound);
    EXPECT_GE(min_angle(fine), 0.999 * bound);
    EXPECT_LE(fine.corners.size(), 10 * coarse.corners.size());
}

TEST(RefinedTriangles, LoseNeitherAreaNorLinesInAnyPlane) {
    const Loops with_hole{square[0], {{0.3, 0.3}, {0.3, 0.6}, {0.6, 0.6}, {0.6, 0.3}}};
    // A line through the hole, two nearly equal ones, and two that meet at one degree.
    const std::vector<LabelledSegment> lines{{{0.2, 0.5}, {0.9, 0.4}, 1},
                                             {{0, 0.8}, {1, 0.8}, 2},
                                             {{0, 0.8 + 1e-9}, {1, 0.8 - 2e-9}, 2},
                                             {{0.1, 0.1}, {0.9, 0.1}, 3},
                                             {{0.1, 0.1}, {0.9, 0.114}, 3}};
    const LabelledTriangles coarse = labelled_triangles(with_hole, lines), fine = refined_triangles(coarse);
    EXPECT_GT(fine.corners.size(), coarse.corners.size());
    EXPECT_LE(fine.corners.size(), 20 * coarse.corners.size());
    EXPECT_NEAR(area(fine), 1 - 0.09, 1e-10);
    for (const std::uint8_t label : {0, 1, 2, 3})
        EXPECT_NEAR(labelled_length(fine, label), labelled_length(coarse, label), 1e-9);
    for (std::size_t i = 0; i < fine.corners.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t n = fine.neighbors[i][k];
            if (n == LabelledTriangles::none) continue;
            EXPECT_NE(std::find(fine.neighbors[n].begin(), fine.neighbors[n].end(), i), fine.neighbors[n].end());
        }
}

TEST(RefinedTriangles, OfAnEmptyMeshAreEmpty) {
    EXPECT_TRUE(refined_triangles({}).corners.empty());
}

}  // namespace
}  // namespace exitance
