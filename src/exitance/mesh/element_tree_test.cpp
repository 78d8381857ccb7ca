#include "exitance/mesh/element_tree.hpp"

#include <gtest/gtest.h>

#include "exitance/core/random.hpp"

namespace exitance {
namespace {

Patch patch(Patch::Shape shape) {
    return {{1, 2, 3}, {2, 0.5, 0}, {-0.3, 1, 0.4}, shape};
}

/// A tree that has been cut in every way there is.
ElementTree well_cut_tree(Patch::Shape shape) {
    ElementTree tree;
    tree.add_root(RegionId(0), patch(shape));
    tree.split(ElementId(0), Cut::both);
    const IdRange<ElementId> children = tree.children(ElementId(0));
    tree.split(children[1], shape == Patch::Shape::triangle ? Cut::both : Cut::u, 0.3);
    tree.split_by_line(children[2], {{0.6, 0.8}, 0.45});
    tree.split_by_line(tree.children(children[2])[1], {{-0.8, 0.6}, -0.1});
    // Around a place within, and around one on a side.
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

TEST_P(EveryShape, TheLeafThatHoldsAPointHoldsIt) {
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
            EXPECT_GT(cross(edge, place.uv - domain[i]), -1e-12);  // inside but for rounding
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
        // A midpoint rule of 64 x 64 cells: up to half a cell is lost at each seam of a cell's fan of triangles.
        EXPECT_NEAR(mean.x, tree.centre(e).x, 0.5 / n);
        EXPECT_NEAR(mean.y, tree.centre(e).y, 0.5 / n);
    }
}

TEST(ElementTree, ALineThatMissesAnElementCutsNothing) {
    ElementTree tree;
    tree.add_root(RegionId(0), patch(Patch::Shape::parallelogram));
    EXPECT_TRUE(tree.split_by_line(ElementId(0), {{1, 0}, 1.5}).is_none());
    EXPECT_TRUE(tree.split_by_line(ElementId(0), {{1, 0}, 0}).is_none());
    EXPECT_TRUE(tree.is_leaf(ElementId(0)));
}

TEST(ElementTree, AFanWithATriangleOfNoAreaIsNone) {
    ElementTree tree;
    tree.add_root(RegionId(0), patch(Patch::Shape::parallelogram));
    EXPECT_TRUE(tree.split_fan(ElementId(0), {{0, 0}, {{0.5, 0}, {1, 0}, {1, 1}, {0, 1}}}).is_none());
    EXPECT_TRUE(tree.is_leaf(ElementId(0)));
    EXPECT_EQ(tree.split_fan(ElementId(0), {{0.5, 0}, {{1, 0}, {1, 1}, {0, 1}, {0, 0}}}), ElementId(1));
    EXPECT_EQ(tree.children(ElementId(0)).size(), 3u);
}

TEST_P(EveryShape, DomainsEndWhereTheyAreReached) {
    const ElementTree tree = well_cut_tree(GetParam());
    for (ElementId e : tree.leaves()) {
        const std::vector<Vec2> domain = tree.domain(e);
        const auto depth = [&](Vec2 uv) {  // within the edge that is nearest, as twice an area
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
