#include "exitance/base/error_share.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace exitance {
namespace {

TEST(ErrorShare, IsEvenIfAllErrorsAreEqual) {
    const std::vector<double> errors(5000, 1.0);
    EXPECT_DOUBLE_EQ(share_of_crowd(errors, 1), 1.0 / 5000);
}

TEST(ErrorShare, GivesUnusedSharesOfSmallErrorsToLargeOnes) {
    // 4,900 errors of 1e-5 use 0.049 of the half (0.5). The other 100 would get 0.451 / 100 each, but the limit is 1 /
    // 1000.
    std::vector<double> errors(4900, 1e-5);
    errors.resize(5000, 1.0);
    EXPECT_DOUBLE_EQ(share_of_crowd(errors, 1), 1e-3);
    // The 1,000 large errors get 0.46 / 1000 each.
    errors.assign(4000, 1e-5);
    errors.resize(5000, 1.0);
    EXPECT_NEAR(share_of_crowd(errors, 1), 0.46e-3, 1e-15);
}

TEST(ErrorShare, IsTheLargestIfAllErrorsAreSmall) {
    EXPECT_DOUBLE_EQ(share_of_crowd(std::vector<double>(8000, 1e-9), 1), 1e-3);
}

TEST(ErrorShare, MeanNoiseIsTheAllowedOne) {
    const std::vector<double> areas = {1, 1, 0.01, 0.04, 9};
    const double m = even_noise_area(areas);
    double sum = 0, all = 0;
    for (const double a : areas) sum += a * std::sqrt(m / a), all += a;
    EXPECT_NEAR(sum, all, 1e-12 * all);
    EXPECT_DOUBLE_EQ(even_noise_area(std::vector<double>(7, 0.3)), 0.3);
}

TEST(ErrorShare, ACrowdIsManyUnsplitPolygons) {
    EXPECT_TRUE(ErrorShare::is_crowd(6000, 5000));
    EXPECT_FALSE(ErrorShare::is_crowd(6000, 1000));
    EXPECT_FALSE(ErrorShare::is_crowd(600, 500));
    EXPECT_FALSE(ErrorShare::is_crowd(6000, 5000, 2));
    EXPECT_TRUE(ErrorShare::is_crowd(9000, 5000, 2));
    EXPECT_LT(ErrorShare::small_area(1000, 20000, 4), ErrorShare::small_area(1000, 20000));
}

}  // namespace
}  // namespace exitance
