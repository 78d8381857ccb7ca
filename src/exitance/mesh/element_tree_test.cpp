#include "exitance/mesh/element_tree.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

Patch patch(Patch::Shape shape) {
    return {{1, 2, 3}, {2, 0.5, 0}, {-0.3, 1, 0.4}, shape};
}

/// A tree that has been split in all supported ways.
ElementTree well_cut_tree(Patch::Shape shape) {
    ElementTree tree;
    tree.add_root(RegionId(0), patch(shape));
    tree.split(ElementId(0), Cut::both);
    const IdRange<ElementId> children = tree.children(ElementId(0));
    tree.split(children[1], shape == Patch::Shape::triangle ? Cut::both : Cut::u, 0.3);
    tree.split_by_line(children[2], {{0.6, 0.8}, 0.45});
    tree.split_by_line(tree.children(children[2])[1], {{-0.8, 0.6}, -0.1});
    // Around a point inside, and around one on a side.
    const std::vector<Vec2> corners = tree.domain(children[0]);
    Fan around{tree.centre(children[0]), corners};
    around.border.push_back(corners[0]);
    tree.split_fan(children[0], around);
    Fan from_side{0.4 * corners[0] + 0.6 * corners[1], {corners.begin() + 1, corners.end()}};
    from_side.border.push_back(corners[0]);
    tree.split_fan(children[3], from_side);
    return tree;
}

class EveryShape : public testing::TestWithParam<Patch::Shape> {};
INSTANTIATE_TEST_SUITE_P(Patches, EveryShape, testing::Values(Patch::Shape::parallelogram, Patch::Shape::triangle));

TEST_P(EveryShape, LeavesTileTheRoot) {
    const ElementTree tree = well_cut_tree(GetParam());
    double area = 0;
    for (ElementId e : tree.leaves()) area += tree.area(e);
    EXPECT_NEAR(area, patch(GetParam()).area(), 1e-14);  // a dozen roundings
    EXPECT_GT(tree.leaves().size(), 6u);
}

TEST_P(EveryShape, LeafAtFindsTheLeafThatContainsAPoint) {
    const ElementTree tree = well_cut_tree(GetParam());
    RandomStream random(1, Stream::mesh);
    for (int k = 0; k < 2000; ++k) {
        const Vec2 uv = uniform_in_shape(GetParam(), random.uniform(), random.uniform());
        const ElementTree::Place place = tree.leaf_at(ElementId(0), uv);
        ASSERT_TRUE(tree.is_leaf(place.element));
        const Point x = tree.patch(ElementId(0)).at(uv);
        EXPECT_LT(norm(tree.patch(place.element).at(place.uv) - x), 1e-13);
        const std::vector<Vec2> domain = tree.domain(place.element);
        for (std::size_t i = 0; i < domain.size(); ++i) {
            const Vec2 edge = domain[(i + 1) % domain.size()] - domain[i];
            EXPECT_GT(cross(edge, place.uv - domain[i]), -1e-12);  // inside except for rounding
        }
    }
}

TEST_P(EveryShape, UniformPlacesHaveTheDomainsCentre) {
    const ElementTree tree = well_cut_tree(GetParam());
    for (ElementId e : tree.leaves()) {
        Vec2 sum;
        constexpr int n = 64;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) sum = sum + tree.uniform(e, (i + 0.5) / n, (j + 0.5) / n);
        const Vec2 mean = (1.0 / (n * n)) * sum;
        // Midpoint rule with 64 x 64 cells: up to half a cell is lost at each seam of a cell's fan of triangles.
        EXPECT_NEAR(mean.x, tree.centre(e).x, 0.5 / n);
        EXPECT_NEAR(mean.y, tree.centre(e).y, 0.5 / n);
    }
}

TEST_P(EveryShape, TrianglesOfFansAreTheSameStoredOrNot) {
    const ElementTree tree = well_cut_tree(GetParam());
    ASSERT_LT(tree.first_of_fans().value, tree.size());
    ElementTree stored = tree;
    stored.add_root(RegionId(1), patch(Patch::Shape::triangle));
    EXPECT_EQ(stored.first_of_fans().value, stored.size());
    EXPECT_EQ(stored.size(), tree.size() + 1);
    EXPECT_EQ(tree.ids().size(), tree.size());
    for (ElementId e : tree.ids()) {
        const Patch a = tree.patch(e), b = stored.patch(e);
        EXPECT_TRUE(a.origin == b.origin && a.a == b.a && a.b == b.b && a.shape == b.shape);
        EXPECT_EQ(tree.area(e), stored.area(e));
        EXPECT_EQ(tree.parent(e), stored.parent(e));
        EXPECT_EQ(tree.region(e), stored.region(e));
        EXPECT_EQ(tree.cut_of(e), stored.cut_of(e));
        EXPECT_EQ(tree.is_cell(e), stored.is_cell(e));
        ASSERT_EQ(tree.children(e).size(), stored.children(e).size());
        for (ElementId child : tree.children(e)) EXPECT_EQ(tree.parent(child), e);
    }
    RandomStream random(1, Stream::mesh);
    for (int k = 0; k < 200; ++k) {
        const Vec2 uv = uniform_in_shape(GetParam(), random.uniform(), random.uniform());
        const ElementTree::Place a = tree.leaf_at(ElementId(0), uv), b = stored.leaf_at(ElementId(0), uv);
        EXPECT_TRUE(a.element == b.element && a.uv == b.uv);
    }
}

TEST(ElementTree, TrianglesOfFansCanBeCut) {
    ElementTree tree = well_cut_tree(Patch::Shape::parallelogram);
    const ElementId last(tree.size() - 1);
    const Patch before = tree.patch(last);
    const ElementId first = tree.split(last, Cut::both);
    EXPECT_EQ(first.value, last.value + 1);
    EXPECT_EQ(tree.patch(first).origin, before.origin);
    EXPECT_EQ(tree.children(last).size(), 4u);
    // Cells can also be split into fans.
    ElementTree fans = well_cut_tree(Patch::Shape::parallelogram);
    const std::vector<Vec2> corners = fans.domain(last);
    const ElementId child = fans.split_fan(last, {fans.centre(last), {corners[0], corners[1], corners[2], corners[0]}});
    EXPECT_EQ(child.value, last.value + 1);
    EXPECT_EQ(fans.parent(child), last);
    EXPECT_NEAR(fans.area(child) + fans.area(ElementId(child.value + 1)) + fans.area(ElementId(child.value + 2)),
                before.area(), 1e-15);  // rounding
}

TEST(ElementTree, CopiesThatDifferByFansShareTheRest) {
    ElementTree tree;
    tree.add_root(RegionId(0), patch(Patch::Shape::parallelogram));
    for (std::uint32_t e = 0; e < 200; ++e) tree.split(ElementId(e), Cut::both);
    ElementTree fans = tree;
    std::size_t triangles = 0;
    for (ElementId leaf : tree.leaves()) {
        std::vector<Vec2> border = fans.domain(leaf);
        border.push_back(border[0]);
        fans.split_fan(leaf, {fans.centre(leaf), border});
        triangles += 4;
    }
    EXPECT_EQ(fans.size(), tree.size() + triangles);
    // One and a half points of 16 bytes per triangle, plus a few bytes per fan.
    EXPECT_LE(fans.memory_bytes() - tree.memory_bytes(), 32 * triangles);
    tree.visit_arrays([&](const auto& of_tree) {
        if (of_tree.size_bytes() != tree.size() * sizeof(Patch)) return;
        bool shared = false;
        fans.visit_arrays([&](const auto& of_fans) {
            shared |= static_cast<const void*>(of_fans.data()) == static_cast<const void*>(of_tree.data());
        });
        EXPECT_TRUE(shared);
    });
}

TEST(ElementTree, ALineThatMissesAnElementCutsNothing) {
    ElementTree tree;
    tree.add_root(RegionId(0), patch(Patch::Shape::parallelogram));
    EXPECT_TRUE(tree.split_by_line(ElementId(0), {{1, 0}, 1.5}).is_none());
    EXPECT_TRUE(tree.split_by_line(ElementId(0), {{1, 0}, 0}).is_none());
    EXPECT_TRUE(tree.is_leaf(ElementId(0)));
}

TEST(ElementTree, AFanWithATriangleWithoutAreaIsRejected) {
    ElementTree tree;
    tree.add_root(RegionId(0), patch(Patch::Shape::parallelogram));
    EXPECT_TRUE(tree.split_fan(ElementId(0), {{0, 0}, {{0.5, 0}, {1, 0}, {1, 1}, {0, 1}}}).is_none());
    EXPECT_TRUE(tree.is_leaf(ElementId(0)));
    EXPECT_EQ(tree.split_fan(ElementId(0), {{0.5, 0}, {{1, 0}, {1, 1}, {0, 1}, {0, 0}}}), ElementId(1));
    EXPECT_EQ(tree.children(ElementId(0)).size(), 3u);
}

TEST_P(EveryShape, ReachEndsOnTheBorderOfTheDomain) {
    const ElementTree tree = well_cut_tree(GetParam());
    for (ElementId e : tree.leaves()) {
        const std::vector<Vec2> domain = tree.domain(e);
        const auto depth = [&](Vec2 uv) {  // distance to the nearest edge, as twice an area
            double least = HUGE_VAL;
            for (std::size_t i = 0; i < domain.size(); ++i)
                least = std::min(least, cross(domain[(i + 1) % domain.size()] - domain[i], uv - domain[i]));
            return least;
        };
        const Vec2 c = tree.centre(e);
        for (const Vec2 uv : {Vec2{0.9, 0.9}, Vec2{-0.5, 0.2}, Vec2{0.3, 1.5}, c}) {
            const double reach = tree.reach(e, uv);
            if (depth(uv) >= 0) {
                EXPECT_EQ(reach, 1);
            } else {
                EXPECT_LT(reach, 1);
                EXPECT_NEAR(depth(c + reach * (uv - c)), 0, 1e-12);
            }
        }
    }
}

}  // namespace
}  // namespace exitance
