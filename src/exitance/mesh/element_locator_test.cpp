#include "exitance/mesh/element_locator.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

using Shape = Patch::Shape;

/// An m x m chequerboard of squares in the plane z = 2, every third square as two triangles; region 1 of 3.
ElementTree chequerboard(int m) {
    ElementTree tree;
    const double s = 1.0 / m;
    for (int j = 0; j < m; ++j)
        for (int i = 0; i < m; ++i) {
            const Point o = {i * s, j * s, 2};
            if ((i + j * m) % 3 != 0) {
                tree.add_root(RegionId(1), {o, {s, 0, 0}, {0, s, 0}, Shape::parallelogram});
                continue;
            }
            tree.add_root(RegionId(1), {o, {s, 0, 0}, {0, s, 0}, Shape::triangle});
            tree.add_root(RegionId(1), {o + Vec3{s, s, 0}, {-s, 0, 0}, {0, -s, 0}, Shape::triangle});
        }
    return tree;
}

class Chequerboards : public testing::TestWithParam<int> {};

TEST_P(Chequerboards, HoldEveryPointInTheLeafFound) {
    ElementTree tree = chequerboard(GetParam());
    for (ElementId e : tree.leaves())
        if (e.value % 2 == 0) tree.split(e, e.value % 4 == 0 ? Cut::u : Cut::both, 0.3);
    const ElementLocator locator(tree, 3);
    RandomStream random(1, Stream::mesh);
    for (int i = 0; i < 2000; ++i) {
        const Point p = {random.uniform(), random.uniform(), 2 + 1e-7 * random.uniform()};
        const ElementTree::Place place = locator.find(RegionId(1), p);
        ASSERT_FALSE(place.element.is_none());
        EXPECT_TRUE(tree.is_leaf(place.element));
        const Point back = tree.patch(place.element).at(place.uv);
        EXPECT_NEAR(back.x, p.x, 1e-14);  // rounding of coordinates of size 1
        EXPECT_NEAR(back.y, p.y, 1e-14);
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Chequerboards, testing::Values(1, 2, 5, 40));

TEST(ElementLocator, AssignsAPointOutsideToTheNearestRoot) {
    const ElementTree tree = chequerboard(20);
    const ElementLocator locator(tree, 3);
    const ElementTree::Place place = locator.find(RegionId(1), {1 + 1e-6, 0.51, 2});
    const Point back = tree.patch(place.element).at(place.uv);
    EXPECT_NEAR(back.x, 1, 1e-14);  // rounding
    EXPECT_NEAR(back.y, 0.51, 1e-14);
}

TEST(ElementLocator, AssignsBordersToTheLowerId) {
    ElementTree tree;
    tree.add_root(RegionId(0), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Shape::parallelogram});
    tree.add_root(RegionId(0), {{1, 0, 0}, {1, 0, 0}, {0, 1, 0}, Shape::parallelogram});
    EXPECT_EQ(ElementLocator(tree, 1).find(RegionId(0), {1, 0.5, 0}).element, ElementId(0u));
}

TEST(ElementLocator, FindsNothingInARegionWithoutRoots) {
    const ElementTree tree = chequerboard(2);
    EXPECT_TRUE(ElementLocator(tree, 3).find(RegionId(0), {0, 0, 0}).element.is_none());
    EXPECT_TRUE(ElementLocator(tree, 3).find(RegionId(2), {0, 0, 0}).element.is_none());
}

TEST(ElementLocator, SupportsRootsOnALine) {
    ElementTree tree;
    for (int i = 0; i < 50; ++i)
        tree.add_root(RegionId(0), {{0, double(i), 0}, {1e-3, 0, 1e-3}, {0, 1, 0}, Shape::parallelogram});
    const ElementLocator locator(tree, 1);
    for (int i = 0; i < 50; ++i) EXPECT_EQ(locator.find(RegionId(0), {5e-4, i + 0.5, 5e-4}).element.value, unsigned(i));
}

}  // namespace
}  // namespace exitance
