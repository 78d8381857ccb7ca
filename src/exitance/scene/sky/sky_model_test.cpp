#include "exitance/scene/sky/sky_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/scene/sky/sun_position.hpp"

namespace exitance {
namespace {

/// Cosine-weighted mean of relative() over the upper half: midpoint rule in Z and azimuth.
double crude_mean(const SkyModel& sky) {
    constexpr int rows = 240, columns = 480;
    double sum = 0;
    for (int i = 0; i < rows; ++i) {
        const double z = (i + 0.5) * 0.5 * pi / rows;
        for (int k = 0; k < columns; ++k) {
            const double phi = (k + 0.5) * 2 * pi / columns;
            sum += std::sin(z) * std::cos(z) *
                   sky.relative({std::sin(z) * std::cos(phi), std::sin(z) * std::sin(phi), std::cos(z)});
        }
    }
    return 2 * sum * 0.5 * pi / rows / columns;
}

}  // namespace

TEST(SkyModel, EveryTypeOfTheGeneralSkyIsNormalizedByItsIntegral) {
    for (int type = 1; type <= 15; ++type) {
        const SkyModel sky = cie_sky(type, sky_direction(35, 200));
        EXPECT_NEAR(crude_mean(sky), 1, 1e-4) << type;  // the error of the midpoint rule
    }
    EXPECT_NEAR(crude_mean(overcast_sky()), 1, 1e-4);
    EXPECT_NEAR(crude_mean(uniform_sky()), 1, 1e-4);
}

TEST(SkyModel, TheOvercastSkyIsThreeTimesAsBrightAtTheZenithAsAtTheHorizon) {
    const SkyModel sky = overcast_sky();
    EXPECT_NEAR(sky.relative({0, 0, 1}) / sky.relative({1, 0, 0}), 3, 1e-12);
    EXPECT_NEAR(sky.relative({0, 0, 1}), 9.0 / 7, 1e-6);  // L_z = 9 E / (7 pi)
}

TEST(SkyModel, AgreesWithTheFormulaOfTheStandard) {
    // Type 12 with the sun at an altitude of 60 degrees, by hand at Z = 45 degrees in the sun's azimuth: gamma = 15
    // degrees.
    const SkyModel sky = cie_sky(12, sky_direction(60, 90));
    const double phi = 1 - std::exp(-0.32 / std::cos(pi / 4)), phi_zenith = 1 - std::exp(-0.32);
    const auto f = [](double gamma) {
        return 1 + 10 * (std::exp(-3 * gamma) - std::exp(-3 * pi / 2)) + 0.45 * std::pow(std::cos(gamma), 2);
    };
    EXPECT_NEAR(sky.value(sky_direction(45, 90)) / sky.value({0, 0, 1}),
                phi * f(15 * pi / 180) / (phi_zenith * f(30 * pi / 180)), 1e-12);
}

TEST(PerezSky, ComputesClearnessAndBrightness) {
    const Normal sun = sky_direction(60, 180);
    const double zenith = 30 * pi / 180, cubed = 1.041 * std::pow(zenith, 3);
    const PerezState clear = perez_state({100, 800, 3}, sun);
    EXPECT_NEAR(clear.clearness, (9 + cubed) / (1 + cubed), 1e-12);
    // The air mass is 1.1547 to 1e-3.
    EXPECT_NEAR(clear.brightness, 100 / (1367 * 1.0351) * 1 / std::sin(pi / 3), 2e-4);
    EXPECT_EQ(perez_state({100, 0, 3}, sun).clearness, 1);
    EXPECT_EQ(perez_state({0, 0, 3}, sun).clearness, 1);
    EXPECT_EQ(perez_state({10, 900, 3}, sun).clearness, 12.01);
}

TEST(PerezSky, IsNormalizedInEveryBinAndBrighterTowardsTheSunWhereItIsClear) {
    for (const double direct : {0.0, 15.0, 40.0, 80.0, 160.0, 300.0, 500.0, 900.0}) {
        const Normal sun = sky_direction(40, 135);
        const SkyModel sky = perez_sky({100, direct, 172}, sun);
        EXPECT_NEAR(crude_mean(sky), 1, 2e-4) << direct;
        for (int a = 0; a < 360; a += 15)
            for (int h = 0; h <= 90; h += 5) EXPECT_GE(sky.relative(sky_direction(h, a)), 0);
        if (direct > 100) {
            EXPECT_GT(sky.relative(sun), 3 * sky.relative(sky_direction(40, 315))) << direct;
        }
    }
}

TEST(PerezSky, ASunBelowTheHorizonIsMovedToIt) {
    const SkyModel sky = perez_sky({5, 0, 172}, sky_direction(-3, 300));
    EXPECT_NEAR(norm(sky.sun), 1, 1e-12);
    EXPECT_EQ(sky.sun.z, 0);
    EXPECT_TRUE(sky.is_sane());
}

}  // namespace exitance
