#include "exitance/mesh/adaptive.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

TEST(SufficientCut, IsAcrossTheDirectionOfVariationIfTheRestIsAllowed) {
    EXPECT_EQ(sufficient_cut(1, {0.95, 0.01}, 0.1), Cut::u);
    EXPECT_EQ(sufficient_cut(1, {0.01, 0.95}, 0.1), Cut::v);
}

TEST(SufficientCut, IsNoneIfTheRestExceedsTheLimitOrIsUnknown) {
    EXPECT_EQ(sufficient_cut(1, {0.5, 0.4}, 0.1), Cut::none);
    EXPECT_EQ(sufficient_cut(1, {0, 0}, 2), Cut::none);
}

TEST(RefineElement, SplitsAParallelogramAcrossTheGivenDirection) {
    ElementTree tree;
    const ElementId root = tree.add_root(RegionId(0), {{0, 0, 0}, {8, 0, 0}, {0, 1, 0}, Patch::Shape::parallelogram});
    const IdRange<ElementId> halves = refine_element(tree, root, Cut::v);
    ASSERT_EQ(halves.size(), 2u);
    for (ElementId half : halves) {
        EXPECT_EQ(norm(tree.patch(half).a), 8);
        EXPECT_EQ(norm(tree.patch(half).b), 0.5);
    }
    for (ElementId part : refine_element(tree, *halves.begin())) EXPECT_EQ(norm(tree.patch(part).a), 4);
}

}  // namespace
}  // namespace exitance
