#include "exitance/error/further_measurements.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

TEST(FurtherMeasurements, AreNotNeededForClearErrors) {
    EXPECT_EQ(further_measurements({0.010, 0.001}, 0.0164, 0.02), 0u);
    EXPECT_EQ(further_measurements({0.030, 0.002}, 0.0164, 0.02), 0u);
    EXPECT_EQ(further_measurements({0, 0}, 0.0164, 0.02), 0u);
}

TEST(FurtherMeasurements, GrowWithTheUncertaintyOfAnErrorAboveTheLimit) {
    // An estimate 0.002 above the limit: at more than two standard errors the points suffice, at 1.25 they must be 2.56
    // times as many, at one standard error four times as many.
    EXPECT_EQ(further_measurements({0.012, 0.0009}, 0.01, 0.0122), 0u);
    EXPECT_EQ(further_measurements({0.012, 0.0016}, 0.01, 0.0122), 2u);
    EXPECT_EQ(further_measurements({0.012, 0.002}, 0.01, 0.0122), 3u);
    EXPECT_EQ(further_measurements({0.012, 0.02}, 0.01, 0.0122), 3u) << "at most four times as many";
}

TEST(FurtherMeasurements, AreNeededBelowTheLimitIfAFewPointsHaveMostOfTheError) {
    EXPECT_EQ(further_measurements({0.0160, 0.0023}, 0.0164, 0.02), 0u) << "1.7 standard errors below the demand";
    EXPECT_EQ(further_measurements({0.0160, 0.003}, 0.0164, 0.02), 2u);
    EXPECT_EQ(further_measurements({0.0160, 0.005}, 0.0164, 0.02), 3u);
}

}  // namespace
}  // namespace exitance
