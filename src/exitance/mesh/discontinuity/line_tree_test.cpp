#include "exitance/mesh/discontinuity/line_tree.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace exitance {
namespace {

const std::vector<Vec2> unit_outline{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

FlatCurve line_curve(Vec2 a, Vec2 b, CurveOrder order) {
    FlatCurve out;
    out.a = a, out.b = b, out.order = order;
    return out;
}

TEST(LineTree, CutsAlongTheStrongestLineThenTheMostEven) {
    LineTree tree(1e-9);
    const std::vector<FlatCurve> curves{line_curve({0.5, 0}, {0.5, 1}, CurveOrder::d2),
                                        line_curve({0.2, 0}, {0.2, 1}, CurveOrder::d1),
                                        line_curve({0, 0.4}, {1, 0.4}, CurveOrder::d1)};
    const std::uint32_t root = tree.add_root(RegionId(0), unit_outline, curves);
    ASSERT_TRUE(tree.split(root));
    // The cut at 0.4 is more even than the other one of order 1, at 0.2; the even line of order 2 comes later.
    EXPECT_NEAR(std::abs(tree.nodes()[root].offset), 0.4, 1e-12);
    const std::uint32_t child = tree.nodes()[root].first_child;
    EXPECT_NEAR(tree.nodes()[child].area + tree.nodes()[child + 1].area, 1, 1e-12);
    ASSERT_TRUE(tree.split(child));
    EXPECT_NEAR(std::abs(tree.nodes()[child].offset), 0.2, 1e-12);
}

TEST(LineTree, KeepsAreaAndFindsLeavesThatContainAPoint) {
    LineTree tree(1e-9);
    const std::uint32_t root =
        tree.add_root(RegionId(0), unit_outline, std::vector{line_curve({0.1, -1}, {0.9, 2}, CurveOrder::d0)});
    for (std::uint32_t n = 0; n < tree.size() && tree.size() < 60; ++n) tree.split(n);
    double area = 0;
    for (const LineTree::Node& n : tree.nodes())
        if (n.is_leaf()) area += n.area;
    EXPECT_NEAR(area, 1, 1e-12);
    for (std::uint32_t n = 0; n < tree.size(); ++n)
        EXPECT_TRUE(!tree.nodes()[n].is_leaf() || tree.leaf_under(root, tree.nodes()[n].centre) == n);
}

TEST(LineTree, LinesNearTheBorderDoNotCut) {
    LineTree tree(1e-6);
    const std::uint32_t root = tree.add_root(
        RegionId(0), unit_outline,
        std::vector{line_curve({0, 1e-9}, {1, 1e-9}, CurveOrder::d0), line_curve({2, 0}, {2, 1}, CurveOrder::d0)});
    EXPECT_TRUE(tree.nodes()[root].curves.empty());
    ASSERT_TRUE(tree.split(root));
    EXPECT_NEAR(tree.nodes()[tree.nodes()[root].first_child].area, 0.5, 1e-12);
}

}  // namespace
}  // namespace exitance
