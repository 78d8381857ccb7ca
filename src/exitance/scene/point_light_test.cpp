#include "exitance/scene/point_light.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

PunctualLight spot(double inner, double outer) {
    return {"spot", PunctualLight::Kind::spot, {}, {0, 0, -1}, Spectrum(2.0), inner, outer};
}

Normal at_angle(double a) {
    return {std::sin(a), 0, -std::cos(a)};
}

}  // namespace

TEST(PunctualLights, ASpotIsFullWithinItsInnerConeAndDarkBeyondItsOuterOne) {
    const PunctualLight light = spot(0.3, 0.6);
    EXPECT_EQ(light.share_towards(at_angle(0.29)), 1);
    EXPECT_EQ(light.share_towards(at_angle(0.61)), 0);
    const double t = (std::cos(0.5) - std::cos(0.6)) / (std::cos(0.3) - std::cos(0.6));
    EXPECT_NEAR(light.share_towards(at_angle(0.5)), t * t, 1e-12);  // rounding
}

TEST(PunctualLights, PowerIsTheIntensityOverAllDirections) {
    const PunctualLight light = spot(0.3, 0.6);
    double sum = 0;
    constexpr int steps = 100000;
    for (int i = 0; i < steps; ++i) {
        const double a = (i + 0.5) * 0.6 / steps;
        sum += 2.0 * light.share_towards(at_angle(a)) * 2 * pi * std::sin(a) * 0.6 / steps;
    }
    EXPECT_NEAR(light.power()[0], sum, 1e-8);  // midpoint rule, 1e5 steps
    PunctualLight bulb;
    bulb.intensity = Spectrum(3.0);
    EXPECT_NEAR(bulb.power()[0], 12 * pi, 1e-12);
    bulb.kind = PunctualLight::Kind::directional;
    EXPECT_EQ(bulb.power()[0], 0);
}

}  // namespace exitance
