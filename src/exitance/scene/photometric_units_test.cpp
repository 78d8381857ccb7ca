#include "exitance/scene/photometric_units.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

TEST(LightUnit, WattsBecomeLuxByRadiancesWeights) {
    Spectrum light(1);
    if constexpr (bands == 3) light[0] = 3, light[1] = 2, light[2] = 1;
    const double weighted = bands == 3 ? 3 * 0.265 + 2 * 0.670 + 0.065 : 1;
    EXPECT_NEAR(LightUnit(UnitChoice::lux, false)(light), 179 * weighted, 1e-10);
    EXPECT_NEAR(LightUnit(UnitChoice::lux, false, 100)(light), 100 * weighted, 1e-10);
    EXPECT_NEAR(LightUnit(UnitChoice::watt, false, 100)(light), mean(light), 1e-12);
}

TEST(LightUnit, LumensAreNotConvertedTwice) {
    const Spectrum light(500);
    EXPECT_NEAR(LightUnit(UnitChoice::lux, true)(light), 500, 1e-10);
    EXPECT_NEAR(LightUnit(UnitChoice::scene, true, 50)(light), 500, 1e-10);
    EXPECT_NEAR(LightUnit(UnitChoice::watt, true, 100)(light), 5, 1e-12);
    EXPECT_FALSE(LightUnit(UnitChoice::lux, true).is_converted());
    EXPECT_TRUE(LightUnit(UnitChoice::lux, false).is_converted());
    EXPECT_FALSE(LightUnit(UnitChoice::scene, false).is_lux());
}

}  // namespace
}  // namespace exitance
