#include "exitance/mesh/cluster_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/mesh/solve_mesh.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

struct Clustered {
    explicit Clustered(const Scene& scene) : pieces(cut_into_pieces(scene)), tree(make_tree()), clusters(tree) {}

    ElementTree make_tree() const {
        ElementTree out;
        for (const Piece& piece : pieces) out.add_root(piece.region, piece.patch);
        return out;
    }

    std::vector<ElementId> members(ClusterId c) const {
        std::vector<ElementId> out;
        for (Body child : clusters.children(c)) {
            if (!child.is_cluster()) {
                out.push_back(child.element());
                continue;
            }
            for (ElementId e : members(child.cluster())) out.push_back(e);
        }
        return out;
    }

    std::vector<Piece> pieces;
    ElementTree tree;
    ClusterTree clusters;
};

TEST(ClusterTree, HoldsEveryPieceOnce) {
    const Scene scene = built_scene("complex", {{"m", "20"}});
    const Clustered of(scene);
    std::vector<ElementId> members = of.members(of.clusters.root());
    std::sort(members.begin(), members.end());
    EXPECT_EQ(members, of.tree.roots());
    EXPECT_LT(of.clusters.size(), of.tree.roots().size());
}

TEST(ClusterTree, BallsAndAreasHoldTheirMembers) {
    const Scene scene = built_scene("complex", {{"m", "6"}});
    const Clustered of(scene);
    for (ClusterId c : of.clusters.ids()) {
        double area = 0;
        for (ElementId e : of.members(c)) {
            area += of.tree.area(e);
            for (const Point& corner : of.tree.outline(e))
                EXPECT_LE(norm(corner - of.clusters.centre(c)), of.clusters.radius(c) * (1 + 1e-12));
        }
        EXPECT_NEAR(of.clusters.area(c), area, 1e-9 * area);
    }
}

TEST(ClusterTree, FacingsAreTheSumsOfTheirMembersWithinTheirSpread) {
    const Scene scene = built_scene("complex", {{"m", "6"}});
    const Clustered of(scene);
    for (ClusterId c : of.clusters.ids()) {
        std::vector<Vec3> sum(of.clusters.facing_count());
        for (ElementId e : of.members(c)) {
            FacingId f = of.clusters.facing_of(e);
            while (f < of.clusters.facings(c).front() || f >= of.clusters.facings(c)[of.clusters.facings(c).size()])
                f = of.clusters.facing(f).above;
            const Normal n = of.tree.patch(e).normal();
            sum[f.value] += of.tree.area(e) * n;
            EXPECT_LE(norm(n - normalized(of.clusters.facing(f).area)), of.clusters.facing(f).spread + 1e-12);
        }
        for (FacingId f : of.clusters.facings(c))
            EXPECT_LT(norm(sum[f.value] - of.clusters.facing(f).area), 1e-9 * of.clusters.facing(f).surface);
    }
}

TEST(ClusterTree, ALargePolygonIsSeparateFromSmallOnes) {
    const Scene scene = built_scene("complex", {{"m", "20"}});
    const Clustered of(scene);
    const auto& pieces = of.tree.roots();
    const ElementId largest = *std::max_element(
        pieces.begin(), pieces.end(), [&](ElementId a, ElementId b) { return of.tree.area(a) < of.tree.area(b); });
    const auto top = of.clusters.children(of.clusters.root());
    EXPECT_NE(std::find(top.begin(), top.end(), Body(largest)), top.end());
}

TEST(ClusterTree, ManyPiecesInOnePlaceAreStillHalved) {
    ElementTree tree;
    for (int i = 0; i < 1000; ++i)
        tree.add_root(RegionId(0), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Patch::Shape::parallelogram});
    for (int i = 0; i < 200; ++i)
        tree.add_root(RegionId(0), {{std::ldexp(1.0, i), 0, 0}, {1, 0, 0}, {0, 1, 0}, Patch::Shape::triangle});
    const ClusterTree clusters(tree);
    EXPECT_EQ(clusters.area(clusters.root()), 1100);
    EXPECT_TRUE(ClusterTree(ElementTree()).ids().empty());
}

}  // namespace
}  // namespace exitance
