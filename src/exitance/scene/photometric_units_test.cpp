#include "exitance/scene/photometric_units.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

TEST(LightUnit, WattsAreConvertedToLuxByRadiancesWeights) {
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

/// Light with different values per band.
Spectrum coloured() {
    Spectrum light;
    for (std::size_t b = 0; b < bands; ++b) light[b] = 100 * static_cast<double>(b + 1);
    return light;
}

TEST(LightUnit, WeightsOfTheBandsSumToOneWhateverTheirNumber) {
    EXPECT_NEAR(luminous_sum(Spectrum(1)), 1, 1e-12);
    if constexpr (bands != 3) {
        EXPECT_NEAR(luminous_sum(coloured()), mean(coloured()), 1e-10) << "all weigh alike";
    }
}

TEST(LightUnit, ATotalIsTheMeanOfWattsAndTheWeightedSumOfLumens) {
    const double weighted = bands == 3 ? 0.265 * 100 + 0.670 * 200 + 0.065 * 300 : mean(coloured());
    EXPECT_NEAR(own_unit(false)(coloured()), mean(coloured()), 1e-10);
    EXPECT_NEAR(own_unit(true)(coloured()), weighted, 1e-10);
    EXPECT_STREQ(own_unit(false).power(), "W");
    EXPECT_STREQ(own_unit(true).power(), "lm");
}

TEST(LightUnit, WattsAndLumensOfTheSameLightAgreeInBothUnits) {
    // A scene in lumens whose bands are 179 times those of one in watts has the same lux and, for white light, the same
    // watts.
    const Spectrum watts = coloured(), lumens = daylight_efficacy * coloured();
    EXPECT_NEAR(LightUnit(UnitChoice::lux, true)(lumens), LightUnit(UnitChoice::lux, false)(watts), 1e-8);
    EXPECT_NEAR(LightUnit(UnitChoice::watt, true)(daylight_efficacy * Spectrum(2)), 2, 1e-12);
}

}  // namespace
}  // namespace exitance
