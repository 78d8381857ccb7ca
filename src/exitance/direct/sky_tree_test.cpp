#include "exitance/direct/sky_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/random.hpp"
#include "exitance/scene/sky/sky_picture.hpp"
#include "exitance/scene/sky/sun_position.hpp"

namespace exitance {
namespace {

const std::vector<Normal> normals = {{0, 0, 1}, {0, 0, -1}, normalized(Vec3{1, 2, 1}), normalized(Vec3{-3, 1, -0.4})};

DistantLight sky_and_ground(const SkyModel& sky) {
    SkyModel ground = uniform_sky();
    ground.below = true;
    return {{{sky, Spectrum(100.0)}, {ground, Spectrum(20.0)}}, {}};
}

/// Irradiance by brute force: the midpoint rule on 1,000 x 500 cells of equal solid angle.
double irradiance(const DistantLight& light, const Normal& n) {
    constexpr int rows = 500, columns = 1000;
    double sum = 0;
    for (int i = 0; i < rows; ++i)
        for (int k = 0; k < columns; ++k) {
            const double z = -1 + 2 * (i + 0.5) / rows, r = std::sqrt(1 - z * z), angle = 2 * pi * (k + 0.5) / columns;
            const Vec3 w{r * std::cos(angle), r * std::sin(angle), z};
            sum += std::max(0.0, dot(n, w)) * mean(light.radiosity(w, false));
        }
    return sum * 4 / (rows * columns);  // L dw: radiosity / pi times 4 pi / count
}

/// Clouds of a few degrees, and lamps of one cell.
SkyModel picture_of_clouds() {
    RandomStream random(1, Stream::mesh);
    std::vector<double> values(SkyPicture::size);
    for (double& value : values) value = 1 + random.uniform() + (random.uniform() < 0.003 ? 20 : 0);
    SkyModel out;
    out.picture = std::make_shared<const SkyPicture>(std::move(values));
    return out;
}

std::vector<SkyModel> skies() {
    const Normal sun = sky_direction(35, 200);
    std::vector<SkyModel> out = {uniform_sky(), overcast_sky(), cie_sky(12, sun), perez_sky({90, 700, 100}, sun),
                                 picture_of_clouds()};
    for (SkyModel& sky : out) EXPECT_TRUE(sky.normalize());
    return out;
}

TEST(SkyTree, OpenLightIsTheIntegralOfTheSky) {
    for (const SkyModel& sky : skies()) {
        const DistantLight light = sky_and_ground(sky);
        const SkyTree tree(light);
        for (const Normal& n : normals) {
            SkyTree::Aim aim;
            tree.aim(n, aim);
            const double exact = irradiance(light, n);
            EXPECT_NEAR(mean(aim.open), exact, 1e-3 * exact);
        }
    }
}

TEST(SkyTree, DirectionsHaveTheirDensityAndWeightsVaryLittle) {
    for (const SkyModel& sky : skies()) {
        const DistantLight light = sky_and_ground(sky);
        const SkyTree tree(light);
        for (const Normal& n : normals) {
            SkyTree::Aim aim;
            tree.aim(n, aim);
            const ScrambledSobol points(7);
            constexpr std::uint32_t rays = 1 << 14;
            double E = 0, squares = 0, solid_angle = 0;
            for (std::uint32_t i = 0; i < rays; ++i) {
                const SkyTree::Direction d = tree.direction(aim, points(i, 0), points(i, 1));
                EXPECT_NEAR(norm(d.w), 1, 1e-12);
                const double cosine = std::max(0.0, dot(n, d.w));
                const double weight = cosine * mean(light.radiosity(d.w, false)) / (pi * d.density);
                E += weight / rays, squares += weight * weight / rays;
                if (cosine > 0) solid_angle += 1 / d.density / rays;
            }
            const double exact = irradiance(light, n);
            EXPECT_NEAR(E, exact, 2e-3 * exact);  // 16,384 stratified points, weights that vary by a tenth
            // Every direction above the horizon is reached; few are near it, where densities are low.
            EXPECT_NEAR(solid_angle, 2 * pi, 0.1 * pi);
            EXPECT_LT(squares - E * E, 0.05 * E * E);
        }
    }
}

TEST(SkyTree, IsEmptyWithoutADome) {
    EXPECT_TRUE(SkyTree({}).empty());
    EXPECT_TRUE(SkyTree({{}, {{{0, 0, 1}, sun_half_angle, Spectrum(1.0)}}}).empty());
}

}  // namespace
}  // namespace exitance
