#include "exitance/error/tolerance/tolerance_law.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace exitance {
namespace {

TEST(ToleranceLaw, KeepsTheToleranceForAnAllowedError) {
    ToleranceLaw law(1);
    EXPECT_EQ(law.factor(0.9, 1), 1);
    EXPECT_LT(law.factor(1.1, 1), 1);
}

/// Returns the number of rounds until an error that falls like tolerance^power is a tenth of its initial value.
int rounds_to_a_tenth(double power) {
    ToleranceLaw law(0.8);
    double tolerance = 1;
    int rounds = 0;
    for (; std::pow(tolerance, power) > 0.1 && rounds < 100; ++rounds)
        tolerance *= law.factor(std::pow(tolerance, power), 0.1);
    return rounds;
}

TEST(ToleranceLaw, LearnsHowSlowlyErrorsFall) {
    EXPECT_LE(rounds_to_a_tenth(1), 3);
    EXPECT_LE(rounds_to_a_tenth(0.5), 4);
    EXPECT_LE(rounds_to_a_tenth(0.25), 8);  // 14 rounds with the initial guess alone
}

TEST(ToleranceLaw, LimitsTheStepOfARound) {
    ToleranceLaw law(1.7);
    for (int round = 0; round < 5; ++round) {
        const double factor = law.factor(1e6, 1);
        EXPECT_GE(factor, 0.03);
        EXPECT_LE(factor, 0.9);
    }
}

}  // namespace
}  // namespace exitance
