#include "exitance/view_factors/closed_variance.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

TEST(ClosedVariance, LimitIsThatOfChiSquareOfTheEntriesThatVary) {
    // 11 closed entries have 10 degrees of freedom; the 99% quantile of chi-square is 23.21 there.
    ClosedVariance eleven;
    for (int k = 0; k < 11; ++k) eleven.add(0.1);
    EXPECT_NEAR(eleven.closed(0), 1, 1e-12);
    EXPECT_NEAR(eleven.limit(0, 2.326), 2.321, 0.01);
    // The errors of two closed entries are opposite: one degree of freedom, quantile 6.63.
    ClosedVariance two;
    two.add(1), two.add(1);
    EXPECT_NEAR(two.closed(0), 1, 1e-12);
    EXPECT_NEAR(two.limit(0, 2.326), 6.63, 0.15);
}

TEST(ClosedVariance, LimitCoversSumsOverGroups) {
    ClosedVariance many;
    many.add(1, 1e-6, 1e-12);                       // a million equal entries
    EXPECT_NEAR(many.limit(0, 3), 9 * 0.25, 1e-9);  // half of the entries have a quarter of the variance
    EXPECT_NEAR(many.limit(std::nullopt, 3), 9, 1e-9);
    EXPECT_EQ(many.limit(0, 0), many.closed(0));
    EXPECT_EQ(ClosedVariance().limit(0, 3), 0);
}

}  // namespace
}  // namespace exitance
