#include "exitance/mesh/leaf_finder.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

/// A parallelogram and a triangle, split randomly in all supported ways. `many`: additionally a square split into so
/// many fans that their triangles are not stored.
ElementTree cut_at_random(int cuts, std::uint64_t seed, bool many = false) {
    ElementTree tree;
    tree.add_root(RegionId(0), {{0, 0, 0}, {3, 0.2, 0}, {0.5, 1, 0}, Patch::Shape::parallelogram});
    tree.add_root(RegionId(1), {{0, 0, 1}, {1, 0, 0}, {0, 2, 0}, Patch::Shape::triangle});
    RandomStream random(seed, Stream::mesh);
    for (int i = 0; i < cuts; ++i) {
        const std::vector<ElementId> leaves = tree.leaves();
        const ElementId leaf = leaves[random.bits() % leaves.size()];
        if (tree.is_cell(leaf) || i % 7 == 3) {
            const Vec2 n = {random.uniform() - 0.5, random.uniform() - 0.5};
            tree.split_by_line(leaf, {n, dot(n, tree.centre(leaf))});
        } else {
            tree.split(leaf, static_cast<Cut>(1 + random.bits() % 3), 0.2 + 0.6 * random.uniform());
        }
    }
    if (many) {
        const std::size_t first = tree.size();
        tree.add_root(RegionId(2), {{0, 0, 2}, {1, 0, 0}, {0, 1, 0}, Patch::Shape::parallelogram});
        for (std::size_t e = first; tree.size() < first + 160000; ++e) tree.split(ElementId(e), Cut::both);
    }
    // Fans of every third leaf, around its centre or a point on its first side.
    for (ElementId leaf : tree.leaves()) {
        if (leaf.value % 3 != 0) continue;
        std::vector<Vec2> corners = tree.domain(leaf);
        corners.push_back(corners[0]);
        if (leaf.value % 2 == 0)
            tree.split_fan(leaf, {tree.centre(leaf), corners});
        else
            tree.split_fan(leaf, {0.3 * corners[0] + 0.7 * corners[1], {corners.begin() + 1, corners.end()}});
    }
    return tree;
}

TEST(LeafFinder, FindsTheSameLeavesAsTheTree) {
    for (const int cuts : {0, 1, 5, 40, 300}) {
        const ElementTree tree = cut_at_random(cuts, static_cast<std::uint64_t>(cuts));
        const LeafFinder finder(tree);
        EXPECT_EQ(finder.size(), tree.leaves().size());
        RandomStream random(2, Stream::mesh);
        for (int i = 0; i < 2000; ++i) {
            const std::size_t root = random.bits() % 2;
            const ElementId e = tree.roots()[root];
            const double s = random.uniform(), t = random.uniform();
            const Vec2 uv = uniform_in_shape(tree.patch(e).shape, s, t);
            const LeafFinder::Found found = finder.find(root, uv);
            const ElementTree::Place place = tree.leaf_at(e, uv);
            ASSERT_EQ(finder.id(found.leaf), place.element);
            LeafFinder::Query query{static_cast<std::uint32_t>(root), uv, 0};
            finder.find(std::span(&query, 1));
            EXPECT_EQ(query.leaf, found.leaf);
            EXPECT_EQ(finder.id(found.leaf), tree.leaves()[found.leaf]);
            // Rounding of at most thirty nested cuts.
            EXPECT_NEAR(found.uv.x, place.uv.x, 1e-9);
            EXPECT_NEAR(found.uv.y, place.uv.y, 1e-9);
        }
    }
}

/// More roots than are built together, some with fans and some without cuts.
TEST(LeafFinder, FindsLeavesOfVeryManyRoots) {
    ElementTree tree;
    constexpr std::uint32_t count = 1000;
    for (std::uint32_t i = 0; i < count; ++i)
        tree.add_root(RegionId(i), {{0, 0, 1.0 * i}, {1, 0, 0}, {0, 1, 0}, Patch::Shape::parallelogram});
    for (std::uint32_t i = 0; i < count; i += 3) tree.split(tree.roots()[i], Cut::both);
    for (std::uint32_t i = 1; i < count; i += 3) tree.split(tree.roots()[i], Cut::u, 0.3);
    for (ElementId leaf : tree.leaves()) {
        std::vector<Vec2> corners = tree.domain(leaf);
        corners.push_back(corners[0]);
        if (leaf.value % 5 == 0) tree.split_fan(leaf, {tree.centre(leaf), corners});
    }
    const LeafFinder finder(tree);
    ASSERT_EQ(finder.size(), tree.leaves().size());
    RandomStream random(7, Stream::mesh);
    for (std::uint32_t root = 0; root < count; ++root) {
        const double u = random.uniform(), v = random.uniform();
        EXPECT_EQ(finder.id(finder.find(root, {u, v}).leaf), tree.leaf_at(tree.roots()[root], {u, v}).element);
    }
}

TEST(LeafFinder, FindsTrianglesOfFansStoredOrNot) {
    const ElementTree tree = cut_at_random(60, 4, true);
    ASSERT_LT(tree.first_of_fans().value, tree.size());
    ElementTree stored = tree;
    stored.add_root(RegionId(3), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Patch::Shape::triangle});
    ASSERT_EQ(stored.first_of_fans().value, stored.size());
    const LeafFinder finder(tree), of_stored(stored);
    EXPECT_LT(finder.own_leaves(), finder.size());
    EXPECT_EQ(of_stored.own_leaves(), of_stored.size());
    RandomStream random(5, Stream::mesh);
    for (int i = 0; i < 2000; ++i) {
        const std::size_t root = random.bits() % 3;
        const double s = random.uniform(), t = random.uniform();
        const Vec2 uv = uniform_in_shape(tree.patch(tree.roots()[root]).shape, s, t);
        const LeafFinder::Found a = finder.find(root, uv), b = of_stored.find(root, uv);
        ASSERT_EQ(a.leaf, b.leaf);
        EXPECT_EQ(a.uv, b.uv);  // bitwise
    }
}

TEST(LeafFinder, SupportsCornersAndEdgesOfTheRoot) {
    const ElementTree tree = cut_at_random(100, 3);
    const LeafFinder finder(tree);
    for (const Vec2 uv : {Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}, Vec2{0.5, 0}, Vec2{0, 0.5}, Vec2{0.5, 0.5}})
        for (std::size_t root = 0; root < 2; ++root) {
            const LeafFinder::Found found = finder.find(root, uv);
            const Point p = tree.patch(tree.roots()[root]).at(uv),
                        back = tree.patch(finder.id(found.leaf)).at(found.uv);
            EXPECT_LT(norm(p - back), 1e-12);  // rounding
        }
}

}  // namespace
}  // namespace exitance
