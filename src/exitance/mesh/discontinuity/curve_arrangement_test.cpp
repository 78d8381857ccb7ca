#include "exitance/mesh/discontinuity/curve_arrangement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

const std::vector<std::vector<Vec2>> square = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

FlatCurve curve(Vec2 a, Vec2 b, CurveOrder order = CurveOrder::d2) {
    return {a, b, order, CurveCause::vertex_edge, RegionId(0), 1};
}

TEST(CurveArrangement, OverlappingCurvesBecomeOneOfTheStrongestKind) {
    const auto [curves, loops] = arranged_curves(
        {curve({0.1, 0.5}, {0.9, 0.5}), curve({0.1, 0.5 + 1e-9}, {0.5, 0.5 - 1e-9}, CurveOrder::d1)}, square, 1e-8);
    ASSERT_EQ(curves.size(), 2u);
    for (const FlatCurve& c : curves) {
        EXPECT_NEAR(c.a.y, 0.5, 2e-8);
        EXPECT_EQ(c.order, std::max(c.a.x, c.b.x) < 0.6 ? CurveOrder::d1 : CurveOrder::d2);
    }
}

TEST(CurveArrangement, CurvesEndAtTheBorderAndMakeCornersThere) {
    const auto [curves, loops] = arranged_curves({curve({-1, -0.7}, {2, 1.7})}, square, 1e-8);
    ASSERT_EQ(curves.size(), 1u);
    EXPECT_EQ(loops[0].size(), 6u);
    for (const Vec2 end : {curves[0].a, curves[0].b})
        EXPECT_TRUE(std::find(loops[0].begin(), loops[0].end(), end) != loops[0].end());
}

TEST(CurveArrangement, CurvesOnTheBorderOrOutsideOrWithoutLengthAreRemoved) {
    const double nan = std::nan("");
    const auto [curves, loops] = arranged_curves(
        {curve({0, 0}, {1, 1e-9}), curve({2, 0}, {3, 1}), curve({0.5, 0.5}, {0.5, 0.5}), curve({0.2, nan}, {0.5, 0.5})},
        square, 1e-8);
    EXPECT_TRUE(curves.empty());
    EXPECT_EQ(loops, square);
}

TEST(CurveArrangement, CurvesAreSplitAtEndsOnThem) {
    const auto [curves, loops] =
        arranged_curves({curve({0.1, 0.5}, {0.9, 0.5}), curve({0.3, 0.5 + 1e-10}, {0.3, 0.8})}, square, 1e-8);
    EXPECT_EQ(curves.size(), 3u);
}

TEST(CurveArrangement, AnEndNearASharpCornerIsACornerOfOneSideOnly) {
    // Nearer than four tolerances to both sides, but not to the corner. If it were a corner of both sides, the loop
    // would visit it twice, and the triangles in between would lose the area behind it.
    const Vec2 end = {2 - 6e-8, 0};
    const std::vector<std::vector<Vec2>> sharp = {{{0, 0}, {2, 0}, {0, 1}}};
    const auto [curves, loops] = arranged_curves({curve({0.5, 0.3}, end)}, sharp, 1e-8);
    ASSERT_EQ(curves.size(), 1u);
    EXPECT_EQ(std::count(loops[0].begin(), loops[0].end(), end), 1);
    EXPECT_EQ(loops[0].size(), 4u);
}

}  // namespace
}  // namespace exitance
