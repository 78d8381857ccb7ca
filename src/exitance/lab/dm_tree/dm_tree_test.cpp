#include "exitance/lab/dm_tree/dm_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

const std::vector<Vec2> square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

double area_of(const DmTree& tree, std::uint32_t face) {
    double twice = 0;
    const auto loop = tree.mesh().loop(face);
    for (std::size_t i = 0; i < loop.size(); ++i)
        twice += cross(tree.mesh().vertices()[loop[i].vertex].at,
                       tree.mesh().vertices()[loop[(i + 1) % loop.size()].vertex].at);
    return twice / 2;
}

/// Checks that every edge is consistent with its faces and neighbours.
void check(const WingedEdgeMesh& mesh) {
    std::size_t borders = 0;
    for (std::uint32_t f = 0; f < mesh.faces().size(); ++f)
        for (const auto& [vertex, edge] : mesh.loop(f)) {
            const WingedEdgeMesh::Edge& e = mesh.edges()[edge];
            const std::size_t s = e.face[0] == f ? 0 : 1;
            ASSERT_EQ(e.face[s], f);
            ASSERT_EQ(e.vertex[s], vertex);
            const WingedEdgeMesh::Edge& before = mesh.edges()[e.before[s]];
            EXPECT_EQ(before.next[before.face[0] == f ? 0 : 1], edge);
        }
    for (const WingedEdgeMesh::Edge& e : mesh.edges()) borders += e.face[1] == WingedEdgeMesh::none;
    EXPECT_GT(borders, 2u);
    // Euler: V - E + F = 1 without the outer face.
    EXPECT_EQ(mesh.vertices().size() + mesh.faces().size(), mesh.edges().size() + 1);
}

DmTree random_tree(std::uint64_t seed, int curves) {
    DmTree tree(square, 1e-9);
    RandomStream random(seed, Stream::mesh);
    for (int i = 0; i < curves; ++i)
        tree.insert({random.uniform(), random.uniform()}, {random.uniform(), random.uniform()}, 0);
    return tree;
}

}  // namespace

TEST(DmTree, ASpanningCutMakesTwoFacesAndNoConstructionEdges) {
    DmTree tree(square, 1e-9);
    tree.insert({0, 0.25}, {1, 0.25}, 3);
    check(tree.mesh());
    ASSERT_EQ(tree.mesh().faces().size(), 2u);
    EXPECT_EQ(tree.construction_edges(), 0u);
    const auto [smaller, larger] = std::minmax({area_of(tree, 0), area_of(tree, 1)});
    EXPECT_NEAR(smaller, 0.25, 1e-12);
    EXPECT_NEAR(larger, 0.75, 1e-12);
    tree.insert({0.2, 0.25}, {0.8, 0.25}, 4);
    EXPECT_EQ(tree.mesh().faces().size(), 2u) << "on a line that is there";
}

TEST(DmTree, ACurveThatEndsInsideAFaceIsCompletedByConstructionEdges) {
    DmTree tree(square, 1e-9);
    tree.insert({0.25, 0.5}, {0.75, 0.5}, 3);
    check(tree.mesh());
    EXPECT_EQ(tree.mesh().faces().size(), 2u);
    EXPECT_EQ(tree.construction_edges(), 2u);
    double curve = 0;
    for (const WingedEdgeMesh::Edge& e : tree.mesh().edges())
        if (e.curve == 3)
            curve += std::abs(tree.mesh().vertices()[e.vertex[1]].at.x - tree.mesh().vertices()[e.vertex[0]].at.x);
    EXPECT_NEAR(curve, 0.5, 1e-12);
}

TEST(DmTree, RandomCurvesLeaveConvexFacesThatCoverTheOutline) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const DmTree tree = random_tree(seed, 25);
        check(tree.mesh());
        double area = 0;
        for (std::uint32_t f = 0; f < tree.mesh().faces().size(); ++f) area += area_of(tree, f);
        EXPECT_NEAR(area, 1, 1e-9);
        for (std::uint32_t f = 0; f < tree.mesh().faces().size(); ++f) {
            const auto loop = tree.mesh().loop(f);
            const auto at = [&](std::size_t i) { return tree.mesh().vertices()[loop[i % loop.size()].vertex].at; };
            for (std::size_t i = 0; i < loop.size(); ++i)
                EXPECT_GT(cross(at(i + 1) - at(i), at(i + 2) - at(i + 1)), -1e-9);
        }
    }
}

TEST(DmTree, EverySchemeCoversTheOutlineAndTheShortestDiagonalHasBetterShapesThanTheLongest) {
    const std::vector<std::uint8_t> label{2};
    double mean[3] = {};
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        const DmTree tree = random_tree(seed, 12);
        for (std::size_t s = 0; s < 3; ++s) {
            const LabelledTriangles t = triangulated(tree, triangulation_names[s].first, label);
            double area = 0, ratio = 0;
            for (const auto& c : t.corners) {
                area += 0.5 * cross(t.points[c[1]] - t.points[c[0]], t.points[c[2]] - t.points[c[0]]);
                ratio += radius_ratio(t.points[c[0]], t.points[c[1]], t.points[c[2]]);
            }
            EXPECT_NEAR(area, 1, 1e-6) << triangulation_names[s].second;
            mean[s] += ratio / static_cast<double>(t.corners.size());
        }
    }
    EXPECT_GT(mean[1], mean[0]);
}

TEST(DmTree, RadiusRatioIsAHalfForEquilateralTriangles) {
    EXPECT_NEAR(radius_ratio({0, 0}, {1, 0}, {0.5, std::numbers::sqrt3 / 2}), 0.5, 1e-12);
    EXPECT_EQ(radius_ratio({0, 0}, {1, 0}, {2, 0}), 0);
}

TEST(DmTree, CoarsePremeshingBoundsFaces) {
    DmTree tree(square, 1e-9);
    tree.insert_grid(4);
    check(tree.mesh());
    EXPECT_EQ(tree.mesh().faces().size(), 16u);
}

}  // namespace exitance
