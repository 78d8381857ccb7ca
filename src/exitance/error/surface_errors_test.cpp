#include "exitance/error/surface_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace exitance {
namespace {

TEST(SurfaceErrors, AreThoseOfTheRoomForFewPoints) {
    std::vector<PointError> points;
    for (int k = 0; k < 100; ++k) points.push_back({SurfaceId(1), 0.5, k % 2 == 0 ? 0.02 : 0.06});
    for (int k = 0; k < 7; ++k) points.push_back({SurfaceId(2), 1, 25});
    const double of_rooms[] = {0.3, 0.3, 0.01};
    const std::vector<FaceError> errors = surface_errors(points, of_rooms);
    ASSERT_EQ(errors.size(), 3u);
    EXPECT_EQ(errors[0].points, 0u);
    EXPECT_EQ(errors[0].error, 0.3);
    EXPECT_EQ(errors[1].points, 100u);
    EXPECT_NEAR(errors[1].error, 0.2, 1e-12);
    EXPECT_EQ(errors[2].points, 0u);
    EXPECT_EQ(errors[2].error, 0.01);
}

TEST(SurfaceErrors, AreAtLeastTheUncertainty) {
    std::vector<PointError> points;
    for (int k = 0; k < 64; ++k) points.push_back({SurfaceId(0), 1, k % 2 == 0 ? 1.0 : -1.0});
    const double of_rooms[] = {1e-9};
    EXPECT_NEAR(surface_errors(points, of_rooms)[0].error, std::sqrt(1 / std::sqrt(63)), 1e-9);
}

}  // namespace
}  // namespace exitance
