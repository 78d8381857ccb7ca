#include "exitance/mesh/spatial_order.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

TEST(SortByPlace, NeighboursInTheOrderAreNear) {
    RandomStream random(1, Stream::mesh);
    ElementTree tree;
    for (int i = 0; i < 4096; ++i)
        tree.add_root(RegionId(0), {{random.uniform(), random.uniform(), 0}, {1e-3, 0, 0}, {0, 1e-3, 0}});
    std::vector<ElementId> elements = tree.leaves();
    sort_by_place(tree, elements);
    double way = 0;
    for (std::size_t i = 1; i < elements.size(); ++i)
        way += norm(tree.patch(elements[i]).origin - tree.patch(elements[i - 1]).origin);
    // The mean step is about twice the mean distance of neighbours, 1/64; in random order it is 0.5.
    EXPECT_LT(way / static_cast<double>(elements.size()), 0.05);
    std::sort(elements.begin(), elements.end(), [](ElementId a, ElementId b) { return a.value < b.value; });
    EXPECT_EQ(elements, tree.leaves());
}

}  // namespace
}  // namespace exitance
