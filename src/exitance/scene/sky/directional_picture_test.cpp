#include "exitance/scene/sky/directional_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/scene/sky/sky_picture.hpp"
#include "exitance/scene/sky/sun_position.hpp"

namespace exitance {
namespace {

/// Returns a direction of the picture, from shares of its width and height, by the documented orientation.
Vec3 direction_of(double u, double v) {
    const double altitude = pi * (0.5 - v), azimuth = pi * (1 - 2 * u);
    return {std::cos(altitude) * std::cos(azimuth), std::cos(altitude) * std::sin(azimuth), std::sin(altitude)};
}

/// Makes a picture of a function of direction, evaluated at the middles of the pixels.
template <class F>
DirectionalPicture picture_of(std::size_t height, const F& radiance) {
    DirectionalPicture out{2 * height, height, {}};
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < 2 * height; ++x) {
            const Vec3 w = direction_of((static_cast<double>(x) + 0.5) / (2.0 * static_cast<double>(height)),
                                        (static_cast<double>(y) + 0.5) / static_cast<double>(height));
            for (std::size_t b = 0; b < bands; ++b) out.radiance.push_back(static_cast<float>(radiance(w, b)));
        }
    return out;
}

/// Returns the irradiance of a plane with normal n: pixel by pixel, each divided into 4 x 4 parts.
double plain_irradiance(const DirectionalPicture& picture, const Normal& n, std::size_t band) {
    constexpr std::size_t parts = 4;
    double sum = 0;
    const double h = static_cast<double>(parts * picture.height), w = static_cast<double>(parts * picture.width);
    for (std::size_t y = 0; y < parts * picture.height; ++y)
        for (std::size_t x = 0; x < parts * picture.width; ++x) {
            const double v = (static_cast<double>(y) + 0.5) / h;
            const double cosine = dot(n, direction_of((static_cast<double>(x) + 0.5) / w, v));
            const double dw = std::sin(pi * v) * (pi / h) * (2 * pi / w);
            if (cosine > 0)
                sum += cosine * dw * picture.radiance[((y / parts) * picture.width + x / parts) * bands + band];
        }
    return sum;
}

/// Returns the irradiance that the model of the picture gives, by directions of equal solid angle, with its discs.
double irradiance_by_model(const DistantLight& light, const Normal& n, std::size_t band) {
    constexpr int rows = 500, columns = 1000;
    double sum = 0;
    for (int i = 0; i < rows; ++i)
        for (int k = 0; k < columns; ++k) {
            const double z = -1 + 2 * (i + 0.5) / rows, r = std::sqrt(1 - z * z), angle = 2 * pi * (k + 0.5) / columns;
            const Vec3 w{r * std::cos(angle), r * std::sin(angle), z};
            sum += std::max(0.0, dot(n, w)) * light.radiosity(w, false)[band] * 4 / (rows * columns);
        }
    for (const DistantLight::Disc& disc : light.discs)
        sum += std::max(0.0, dot(n, disc.towards)) * disc.irradiance[band];
    return sum;
}

/// A sky with a glow, a brown ground, and stripes of one degree.
double outdoors(const Vec3& w, std::size_t band) {
    const double stripes = 1 + 0.5 * std::sin(40 * w.x) * std::sin(35 * w.y);
    if (w.z < 0) return (2 + static_cast<double>(bands - band)) * stripes;
    return (10 + 5 * static_cast<double>(band) + 30 * std::exp(-8 * (1 - dot(w, sky_direction(30, 120))))) * stripes;
}

const std::vector<Normal> normals = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, normalized(Vec3{1, -2, 1})};

TEST(DirectionalPicture, LightIsTheIntegralOfThePixels) {
    for (const std::size_t height : {50, 64, 256}) {  // rows that do not fit into cells, that fit, and finer ones
        const DirectionalPicture picture = picture_of(height, outdoors);
        const DistantLight light = light_of_picture(picture, 0);
        EXPECT_TRUE(light.is_sane());
        EXPECT_TRUE(light.discs.empty());
        for (const std::size_t band : {std::size_t(0), bands - 1})
            for (const Normal& n : normals) {
                const double exact = plain_irradiance(picture, n, band);
                // Linear interpolation between cells of 2.8 degrees.
                EXPECT_NEAR(irradiance_by_model(light, n, band), exact, 5e-3 * exact) << height;
            }
        // A horizontal plane has the exact sum. The test's own sum has samples of a quarter of a pixel, hence 1e-3.
        EXPECT_NEAR(horizontal_irradiance(picture, false)[0] / plain_irradiance(picture, {0, 0, 1}, 0), 1, 1e-3);
        double above = 0;
        for (const DistantLight::Dome& dome : light.domes)
            if (!dome.model.below) above += dome.irradiance[0];
        EXPECT_NEAR(above / horizontal_irradiance(picture, false)[0], 1, 1e-12);
    }
}

TEST(DirectionalPicture, TheMiddleLooksAlongXAndRotationIsCounterClockwise) {
    const auto spot = [](const Vec3& w, std::size_t) { return 1 + 20 * std::exp(-20 * (1 - w.x)); };
    for (const double degrees : {0.0, 90.0, -37.5, 360.0}) {
        const DistantLight light = light_of_picture(picture_of(64, spot), degrees);
        const double angle = degrees * pi / 180;
        const Vec3 towards{std::cos(angle), std::sin(angle), 0.02}, away{-std::cos(angle), -std::sin(angle), 0.02};
        EXPECT_NEAR(mean(light.radiosity(normalized(towards), false)) / pi, 21, 1)
            << degrees;  // a spot of 18 degrees, averaged over 2.8
        EXPECT_NEAR(mean(light.radiosity(normalized(away), false)) / pi, 1, 1e-3) << degrees;
    }
    // A quarter of the width from the left is +y, three quarters are -y.
    const DirectionalPicture plain = picture_of(32, [](const Vec3& w, std::size_t) { return w.y > 0 ? 3.0 : 1.0; });
    EXPECT_EQ(plain.radiance[(16 * 64 + 16) * bands], 3);
    EXPECT_EQ(plain.radiance[(16 * 64 + 48) * bands], 1);
}

TEST(DirectionalPicture, TheSunBecomesADiscAndIsNotCountedTwice) {
    constexpr double half_angle = 1.2 * degree, radiance = 1e4;
    for (const double altitude : {5.0, 41.0, 85.0, -20.0}) {
        const Normal sun = sky_direction(altitude, 200);
        const auto sky = [&](const Vec3& w, std::size_t band) {
            return 10 + static_cast<double>(band) + (dot(w, sun) > std::cos(half_angle) ? radiance : 0);
        };
        const DirectionalPicture picture = picture_of(360, sky);
        const DistantLight light = light_of_picture(picture, 0);
        ASSERT_EQ(light.discs.size(), 1U) << altitude;
        const DistantLight::Disc& disc = light.discs[0];
        // Pixels of half a degree: 18 of them lie in the disc, and its border is rough.
        EXPECT_LT(std::acos(std::min(1.0, dot(disc.towards, sun))), 0.2 * degree) << altitude;
        EXPECT_NEAR(disc.half_angle / half_angle, 1, 0.1) << altitude;
        const DirectionalPicture plain =
            picture_of(360, [](const Vec3&, std::size_t band) { return 10 + static_cast<double>(band); });
        for (const std::size_t band : {std::size_t(0), bands - 1}) {
            const double of_spot = plain_irradiance(picture, sun, band) - plain_irradiance(plain, sun, band);
            EXPECT_NEAR(disc.irradiance[band], of_spot, 2e-3 * of_spot) << altitude;  // the parts of the test
            for (const bool is_below : {false, true})
                for (const DistantLight::Dome& dome : light.domes)
                    if (dome.model.below == is_below && dome.irradiance[band] > 0) {
                        EXPECT_NEAR(dome.irradiance[band], pi * (10 + static_cast<double>(band)), 1e-3) << altitude;
                    }
        }
    }
}

TEST(DirectionalPicture, WindowsAndEvenSkiesAreNoSuns) {
    const auto window = [](const Vec3& w, std::size_t) {
        return w.x > 0.5 && std::abs(w.y) < 0.3 && std::abs(w.z) < 0.3 ? 200.0 : 1.0;
    };
    EXPECT_TRUE(light_of_picture(picture_of(128, window), 0).discs.empty());
    const DistantLight even = light_of_picture(picture_of(16, [](const Vec3&, std::size_t) { return 2.0; }), 30);
    EXPECT_TRUE(even.discs.empty());
    ASSERT_EQ(even.domes.size(), 2U);  // grey: one dome above and one below
    for (const Vec3& w : normals) EXPECT_NEAR(even.radiosity(w, true)[0] / pi, 2, 1e-5);
    EXPECT_TRUE(light_of_picture(picture_of(4, [](const Vec3&, std::size_t) { return 0.0; }), 0).empty());
    EXPECT_FALSE(light_of_picture({2, 1, std::vector<float>(2 * bands, 1.0F)}, 0).empty());
}

TEST(DirectionalPicture, ATwinOfTheSunAcrossTheEndsOfRowsIsOneDisc) {
    const Normal sun = normalized(Vec3{-1, 0.001, 0.4});  // the left and right ends of the picture meet at -x
    const auto sky = [&](const Vec3& w, std::size_t) { return 1 + (dot(w, sun) > std::cos(0.02) ? 1e4 : 0); };
    EXPECT_EQ(light_of_picture(picture_of(360, sky), 0).discs.size(), 1U);
    const auto zenith = [&](const Vec3& w, std::size_t) { return 1 + (w.z > std::cos(0.02) ? 1e4 : 0); };
    const DistantLight light = light_of_picture(picture_of(360, zenith), 0);
    ASSERT_EQ(light.discs.size(), 1U);
    EXPECT_GT(light.discs[0].towards.z, std::cos(1e-3));
}

}  // namespace
}  // namespace exitance
