#include "exitance/measure/glare/glare_rules.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace exitance {
namespace {

TEST(Guth, PositionIndexAgreesWithTheTable) {
    // CIE 117, table of position indices by T/R (aside) and H/R (above); the formula agrees within a few percent.
    const Normal view{1, 0, 0};
    EXPECT_NEAR(guth_position(view, {1, 0, 0}), 1, 1e-12);
    for (const auto& [h, p] : {std::pair{0.2, 1.53}, {0.5, 2.86}, {0.8, 5.00}, {1.0, 7.00}})
        EXPECT_NEAR(guth_position(view, {1, 0, h}), p, 0.1 * p) << h;
    // Computed by hand: tau 53.13, sigma 51.34 degrees.
    EXPECT_NEAR(guth_position(view, {2, 2, 1.5}), 5.17503, 1e-4);
    EXPECT_NEAR(guth_position(view, {2, -2, 1.5}), 5.17503, 1e-4);
    EXPECT_NEAR(guth_position(view, {1, 0, -0.5}), 1.4, 1e-12);
    EXPECT_NEAR(guth_position(view, {1, 0, -1}), 2.2, 1e-12);
}

/// A direction given by T/R and H/R, for an observer looking along (cos a, sin a, 0); any length.
Vec3 seen(double a, double t, double h, double length) {
    return length * Vec3{std::cos(a) + t * std::sin(a), std::sin(a) - t * std::cos(a), h};
}

TEST(GlareLimit, FollowsGuthsTableForAnyDirectionAndDistance) {
    struct Case {
        double t, h;
        GlareLimit limit;
    };
    for (const double angle : {0.0, pi / 2, 0.7, -2.1})
        for (const double length : {0.3, 1.0, 40.0})
            for (const double side : {-1.0, 1.0})
                for (const Case& c : {Case{0, 1, GlareLimit::none},
                                      {0, 1.69, GlareLimit::none},
                                      {0, 1.71, GlareLimit::overhead},
                                      {0.5, 1.79, GlareLimit::none},
                                      {0.5, 1.81, GlareLimit::overhead},
                                      {1, 1.89, GlareLimit::none},
                                      {1, 1.91, GlareLimit::overhead},
                                      {2.99, 1.89, GlareLimit::none},
                                      {3.01, 1, GlareLimit::aside},
                                      {3.01, 3, GlareLimit::aside},
                                      {0, 2.67, GlareLimit::overhead},
                                      {0, 8, GlareLimit::overhead},
                                      {0, -5, GlareLimit::none}}) {
                    const Normal view{std::cos(angle), std::sin(angle), 0};
                    EXPECT_EQ(glare_limit(view, seen(angle, side * c.t, c.h, length), c.h > 0), c.limit)
                        << angle << ' ' << c.t << ' ' << c.h;
                }
}

TEST(GlareLimit, ExcludesLuminairesAboveTheEyeWithNearlyHorizontalLight) {
    const Normal view{0, 1, 0};
    // Directions slightly below and above the limit of 85 degrees from the nadir.
    const double low = std::tan(4.9 * pi / 180), high = std::tan(5.1 * pi / 180);
    EXPECT_EQ(glare_limit(view, {0, 1, high}, true), GlareLimit::none);
    EXPECT_EQ(glare_limit(view, {0, 1, low}, true), GlareLimit::level);
    EXPECT_EQ(glare_limit(view, {1, 1, std::sqrt(2) * high}, true), GlareLimit::none);
    EXPECT_EQ(glare_limit(view, {1, 1, std::sqrt(2) * low}, true), GlareLimit::level);
    EXPECT_EQ(glare_limit(view, {0, 1, low}, false), GlareLimit::none) << "a luminous wall goes below the eye";
    EXPECT_EQ(glare_limit(view, {0, 1, -0.2}, false), GlareLimit::none);
}

TEST(GlareLimit, IsMeasuredFromATiltedLineOfSight) {
    const double up = 40 * pi / 180;
    const Normal view{0, std::cos(up), std::sin(up)};
    EXPECT_EQ(glare_limit(view, {0, 0.5, 2}, true), GlareLimit::none)
        << "76 degrees above the floor, 36 above the line";
    EXPECT_EQ(glare_limit({0, 1, 0}, {0, 0.5, 2}, true), GlareLimit::overhead);
    EXPECT_EQ(glare_limit({0, 0, 1}, {0, 0.5, 2}, true), GlareLimit::none);
}

}  // namespace
}  // namespace exitance
