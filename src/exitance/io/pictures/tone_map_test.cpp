#include "exitance/io/pictures/tone_map.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

TEST(ToneMap, EveryCurveRisesFromBlackOverMiddleGreyToWhite) {
    for (const ToneCurve curve : {ToneCurve::photographic, ToneCurve::filmic, ToneCurve::linear}) {
        const ToneMap tones{2, 4, curve};
        double before = 0;
        for (double light = 0; light < 5; light += 0.01) {
            const double shown = tones(Spectrum(light))[0];
            EXPECT_GE(shown, before);
            before = shown;
        }
        EXPECT_NEAR(tones(Spectrum(0.09))[1], 0.18, 0.03);  // photographic: 0.154
        EXPECT_EQ(tones(Spectrum(0))[2], 0);
        EXPECT_EQ(tones(Spectrum(1e30))[2], 1);
    }
}

TEST(ToneMap, TheLinearCurveKeepsRatios) {
    Spectrum light(0.1);
    light[0] = 0.05;
    const DisplayColour colour = ToneMap{3, 4, ToneCurve::linear}(light);
    EXPECT_NEAR(colour[0], 0.15, 1e-15);
    EXPECT_NEAR(colour[2], 0.3, 1e-15);
}

}  // namespace
}  // namespace exitance
