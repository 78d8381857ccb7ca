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

/// Roots a billionth as wide as long, as overlapping faces leave, whose sides and gradients are parallel but for
/// rounding, and one whose gradients are parallel.
TEST(ElementLocator, SupportsRootsThatAreVeryThin) {
    for (const double scale : {1e-3, 1.0, 1e3})
        for (const double thin : {6e-9, 1e-12, 1e-17, 0.0})
            for (const double angle : {0.0, 0.3, 1.2}) {
                const Vec3 a = {scale * std::cos(angle), scale * std::sin(angle), 0};
                const Vec3 b = {-scale * std::sin(angle), scale * std::cos(angle), 0};
                ElementTree tree;
                const auto at = [&](double u, double v) { return Point{3 * scale, 0, scale} + u * a + v * b; };
                tree.add_root(RegionId(0), {at(0, 2), thin * b, 2.7 * (a + thin * b), Shape::parallelogram});
                for (int i = 0; i < 12; ++i) tree.add_root(RegionId(0), {at(i, 0), a, b, Shape::parallelogram});
                tree.add_root(RegionId(0), {at(0, 2), 2.7 * a, a + thin * b, Shape::triangle});
                const ElementLocator locator(tree, 1);
                for (unsigned i = 0; i < 12; ++i)
                    EXPECT_EQ(locator.find(RegionId(0), at(i + 0.5, 0.5)).element.value, i + 1) << thin << ' ' << scale;
                EXPECT_FALSE(locator.find(RegionId(0), at(0.5, 2)).element.is_none());
            }
}

TEST(ElementLocator, FindsARootIfAllAreWithoutArea) {
    for (const int count : {2, 9}) {
        ElementTree tree;
        for (int i = 0; i < count; ++i)
            tree.add_root(RegionId(0), {{0, double(i), 0}, {1, 0, 0}, {0.5, 0, 0}, Shape::triangle});
        EXPECT_FALSE(ElementLocator(tree, 1).find(RegionId(0), {0.5, 0.5, 0}).element.is_none());
    }
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
