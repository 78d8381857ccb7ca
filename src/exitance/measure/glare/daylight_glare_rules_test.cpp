#include "exitance/measure/glare/daylight_glare_rules.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/measure/glare/glare_rules.hpp"

namespace exitance {
namespace {

const Normal ahead{0, 1, 0};

/// Direction at an angle sigma from the line of sight; tau 0 is above it, 90 beside it, 180 below it, degrees.
Vec3 seen_at(double sigma, double tau) {
    const double s = std::sin(sigma * degree);
    return {s * std::sin(tau * degree), std::cos(sigma * degree), s * std::cos(tau * degree)};
}

TEST(DaylightPosition, IsGuthsIndexAboveTheLineOfSight) {
    for (const double sigma : {1.0, 20.0, 45.0, 55.0})
        for (const double tau : {0.0, 30.0, 89.0})
            EXPECT_DOUBLE_EQ(daylight_position(ahead, seen_at(sigma, tau)), guth_position(ahead, seen_at(sigma, tau)));
}

TEST(DaylightPosition, FollowsIwataAndOsterhausBelowTheLineOfSight) {
    // For sigma 30 and tau 180 degrees, beta = atan(0.57735 x 1.15) = 33.5822; exp(0.217948 + 0.236829).
    EXPECT_NEAR(daylight_position(ahead, seen_at(30, 180)), 1.57583, 1e-4);
    // For sigma 45 and tau 135, beta = atan(sqrt(1.16125)) = 47.1395; exp(0.305936 + 0.466647).
    EXPECT_NEAR(daylight_position(ahead, seen_at(45, 135)), 2.16536, 1e-4);
}

TEST(DaylightPosition, IsContinuousAcrossTheHorizontal) {
    // The two formulas differ by the rounding of Guth's coefficients at tau = 90 degrees.
    for (const double sigma : {5.0, 30.0, 60.0})
        EXPECT_NEAR(daylight_position(ahead, seen_at(sigma, 89.99)) / daylight_position(ahead, seen_at(sigma, 90.01)),
                    1, 2e-3);
}

TEST(DaylightPosition, IsAtMostSixteen) {
    EXPECT_DOUBLE_EQ(daylight_position(ahead, seen_at(85, 0)), 16);
    for (double tau = 0; tau <= 180; tau += 5) EXPECT_LE(daylight_position(ahead, seen_at(89.9, tau)), 16);
}

TEST(DaylightGlareProbability, AgreesWithAHandCalculation) {
    // 5.87e-5 x 3000 + 0.0918 log10(1 + 5e6 / 3000^1.87) + 0.16, 3000^1.87 = 3.1784e6.
    EXPECT_NEAR(daylight_glare_probability(3000, 5e6), 0.1761 + 0.0918 * std::log10(1 + 5e6 / 3.1784e6) + 0.16, 1e-5);
    EXPECT_DOUBLE_EQ(daylight_glare_probability(0, 0), 0);
    EXPECT_DOUBLE_EQ(daylight_glare_probability(1e5, 1e9), 1);
}

TEST(DaylightGlareProbability, IsReducedInLowLight) {
    EXPECT_DOUBLE_EQ(low_light_factor(1000), 1);
    EXPECT_NEAR(low_light_factor(4 / 0.024), 0.5, 1e-12);
    EXPECT_NEAR(low_light_factor(999.999), 1, 1e-8);
    EXPECT_NEAR(daylight_glare_probability(4 / 0.024, 0), 0.5 * (5.87e-5 * 4 / 0.024 + 0.16), 1e-12);
}

TEST(DaylightGlareProbability, HasTheClassesOfItsAuthors) {
    EXPECT_STREQ(glare_class(0.3499), "imperceptible");
    EXPECT_STREQ(glare_class(0.35), "perceptible");
    EXPECT_STREQ(glare_class(0.40), "disturbing");
    EXPECT_STREQ(glare_class(0.45), "intolerable");
}

/// A row of parts beside each other, `step` radians apart, of 3000 cd/m^2 and 1e-4 sr.
std::vector<GlarePart> row(double first, double step, int count, double luminance = 3000) {
    std::vector<GlarePart> out;
    for (int i = 0; i < count; ++i)
        out.push_back({{std::sin(first + i * step), std::cos(first + i * step), 0}, luminance, 1e-4, 7});
    return out;
}

TEST(JoinedGlareParts, ChainsOfNearPartsAreOneSource) {
    std::vector<GlarePart> parts = row(0, 0.09, 5);
    const std::vector<GlarePart> apart = row(0.36 + 0.11, 0.09, 2);
    parts.insert(parts.end(), apart.begin(), apart.end());
    const std::vector<DaylightGlareSource> sources = join_glare_parts(ahead, parts);
    ASSERT_EQ(sources.size(), 2u);
    EXPECT_NEAR(sources[0].solid_angle, 5e-4, 1e-12);
    EXPECT_NEAR(sources[0].luminance, 3000, 1e-9);
    EXPECT_NEAR(std::atan2(sources[0].towards.x, sources[0].towards.y), 0.18, 1e-9);
    EXPECT_EQ(sources[0].origin, 7u);
    EXPECT_NEAR(sources[1].solid_angle, 2e-4, 1e-12);
}

TEST(JoinedGlareParts, PeaksAreSourcesOfTheirOwn) {
    std::vector<GlarePart> parts = row(0, 0.02, 20);
    parts.push_back({normalized({0.1, 1, 0}), 1e6, 6.8e-5, 9});
    const std::vector<DaylightGlareSource> sources = join_glare_parts(ahead, parts);
    ASSERT_EQ(sources.size(), 2u);
    EXPECT_EQ(sources[0].origin, 9u);
    EXPECT_NEAR(sources[0].luminance, 1e6, 1e-3);
    EXPECT_NEAR(sources[1].luminance, 3000, 1e-9);
}

TEST(JoinedGlareParts, DoNotDependOnTheOrder) {
    std::vector<GlarePart> parts = row(-1.2, 0.03, 30);
    const std::vector<GlarePart> more = row(0.1, 0.04, 9, 70000);
    parts.insert(parts.end(), more.begin(), more.end());
    const std::vector<DaylightGlareSource> one = join_glare_parts(ahead, parts);
    std::reverse(parts.begin(), parts.end());
    const std::vector<DaylightGlareSource> other = join_glare_parts(ahead, parts);
    ASSERT_EQ(one.size(), other.size());
    for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one[i].term() / other[i].term(), 1, 1e-12);
}

}  // namespace
}  // namespace exitance
