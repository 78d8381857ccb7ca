// Light of skies and suns at points, compared with integrals and closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "exitance/scene/sky/directional_picture.hpp"
#include "exitance/scene/sky/sun_position.hpp"
#include "exitance/transport/stage.hpp"
#include "support/checked_scene.hpp"

namespace exitance {
namespace {

struct Corners {
    std::vector<Point> at;
};

Scene under(const DistantLight& light, const std::vector<Corners>& faces) {
    SceneDescription d;
    d.file = "open.obj";
    d.materials = {{"grey", Spectrum(0.5), {}}};
    d.groups = {"all"};
    for (const Corners& face : faces) add_polygon(d, face.at);
    d.distant = light;
    return checked_scene(std::move(d));
}

const Corners ground{{{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}}};

double light_at(const Stage& stage, const Point& x, const Normal& n, RegionId own) {
    DirectLight::Workspace workspace;
    const double exact = stage.direct.irradiance(x, n, own, workspace)[0];
    if (own.is_none()) return exact;
    // Compares with the light from a prepared part of the surface.
    ReceiverLight light;
    const Frame frame(n);
    const double r = 0.01;
    const std::vector<Point> part{x - r * frame.u - r * frame.v, x + r * frame.u - r * frame.v,
                                  x + r * frame.u + r * frame.v, x - r * frame.u + r * frame.v};
    stage.direct.prepare(part, n, own, light, workspace);
    Spectrum from_outside;
    EXPECT_NEAR(stage.direct.irradiance(light, x, workspace, &from_outside)[0], exact, 1e-9 * exact + 1e-12);
    EXPECT_NEAR(from_outside[0], exact, 1e-9 * exact + 1e-12);
    return exact;
}

const RegionId first(0);

}  // namespace

TEST(DistantLight, OpenGroundHasTheIrradianceOfEverySky) {
    const Normal sun = sky_direction(35, 200);
    for (int type = 0; type <= 16; ++type) {
        const SkyModel sky = type == 0    ? overcast_sky()
                             : type == 16 ? perez_sky({90, 700, 100}, sun)
                                          : cie_sky(type, sun);
        const Scene scene = under({{{sky, Spectrum(100.0)}}, {}}, {ground});
        const Stage stage(scene);
        EXPECT_NEAR(light_at(stage, {1, 2, 0}, {0, 0, 1}, first), 100, 0.1) << type;
        EXPECT_NEAR(light_at(stage, {1, 2, 3}, {0, 0, 1}, RegionId()), 100, 0.1) << type;
    }
}

TEST(DistantLight, NothingReachesTheInsideOfAClosedBox) {
    // Rounding leaves slivers of the sky between walls that meet.
    for (const double turn : {0.0, 0.3, 1.1})
        for (const double size : {1e-3, 1.0, 1e3}) {
            const auto at = [&](double x, double y, double z) {
                return Point{size * (x * std::cos(turn) - y * std::sin(turn)) + 7 * size,
                             size * (x * std::sin(turn) + y * std::cos(turn)), size * z};
            };
            const std::vector<Corners> inside{{{at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0)}},
                                              {{at(0, 0, 1), at(0, 1, 1), at(1, 1, 1), at(1, 0, 1)}},
                                              {{at(0, 0, 0), at(0, 0, 1), at(1, 0, 1), at(1, 0, 0)}},
                                              {{at(1, 0, 0), at(1, 0, 1), at(1, 1, 1), at(1, 1, 0)}},
                                              {{at(1, 1, 0), at(1, 1, 1), at(0, 1, 1), at(0, 1, 0)}},
                                              {{at(0, 1, 0), at(0, 1, 1), at(0, 0, 1), at(0, 0, 0)}}};
            const Scene scene = under({{{uniform_sky(), Spectrum(100.0)}}, {}}, inside);
            const Stage stage(scene);
            DirectLight::Workspace workspace;
            for (int k = 1; k < 100; ++k)
                EXPECT_EQ(
                    stage.direct.irradiance(at(0.01 * k, std::fmod(0.618 * k, 1), 0), {0, 0, 1}, first, workspace),
                    Spectrum())
                    << "turned by " << turn << ", size " << size << ", place " << k;
        }
}

TEST(DistantLight, GroundBesideAWallHasTheLightOfThePixelsThatItSees) {
    // A glow, a sun of 1.5 degrees above it, blue and brown stripes; a wall hides a fifth of the sky and not the sun.
    const Normal sun = normalized(Vec3{-1, 0.3, 0.9});
    DirectionalPicture picture{512, 256, {}};
    Spectrum open, beside;
    constexpr std::size_t parts = 4;  // samples per side of a pixel, for the reference
    for (std::size_t i = 0; i < picture.width * picture.height; ++i) {
        const auto row = static_cast<double>(i / picture.width), column = static_cast<double>(i % picture.width);
        const auto towards = [&](double down, double along) {
            const double altitude = pi * (0.5 - (row + down) / 256), azimuth = pi * (1 - 2 * (column + along) / 512);
            return Vec3{std::cos(altitude) * std::cos(azimuth), std::cos(altitude) * std::sin(azimuth),
                        std::sin(altitude)};
        };
        const Vec3 middle = towards(0.5, 0.5);
        Spectrum L(middle.z < 0 ? 3 : 10 + 40 * std::exp(-10 * (1 - dot(middle, sun))));
        L[bands - 1] *= 1.5 + std::sin(30 * middle.x);
        if (dot(middle, sun) > std::cos(0.75 * pi / 180)) L += Spectrum(2e5);
        for (const double value : L.value) picture.radiance.push_back(static_cast<float>(value));
        for (std::size_t k = 0; k < parts * parts; ++k) {
            const Vec3 w =
                towards((static_cast<double>(k / parts) + 0.5) / parts, (static_cast<double>(k % parts) + 0.5) / parts);
            if (w.z <= 0) continue;
            const double dw = std::sqrt(1 - w.z * w.z) * (pi / 256) * (pi / 256) / (parts * parts);
            open += w.z * dw * L;
            const bool is_hidden = w.x > 0 && std::abs(w.y) < 4 * w.x && w.z < 3 * w.x;
            if (!is_hidden) beside += w.z * dw * L;
        }
    }
    const DistantLight light = light_of_picture(picture, 0);
    EXPECT_EQ(light.discs.size(), 1U);
    const Scene scene = under(light, {ground, {{{1, -4, 0}, {1, -4, 3}, {1, 4, 3}, {1, 4, 0}}}});
    const Stage stage(scene);
    DirectLight::Workspace exact;
    PlaceLight::Workspace room;
    const auto compare = [](const Spectrum& found, const Spectrum& expected, double tolerance) {
        for (const std::size_t band : {std::size_t(0), bands - 1})
            EXPECT_NEAR(found[band], expected[band], tolerance * expected[band]);
    };
    // Above the wall nothing hides the sky. The picture is averaged over cells of 2.8 degrees, which changes the light
    // on a horizontal plane little.
    compare(stage.direct.irradiance({0, 0, 4}, {0, 0, 1}, RegionId(), exact), open, 3e-3);
    compare(stage.direct.irradiance({0, 0, 0}, {0, 0, 1}, first, exact), beside,
            5e-3);  // cells at the border of the wall are averages, too
    const PlaceLight::Estimate by_rays =
        stage.place_light.by_rays({0, 0, 0}, {0, 0, 1}, first, {.relative = 2e-3, .max_rays = 1 << 16}, room);
    compare(by_rays.irradiance, beside, 1e-2);
}

TEST(DistantLight, AWallGetsHalfOfAUniformSkyAndTheGroundHidesItsGlow) {
    SkyModel below = uniform_sky();
    below.below = true;
    const Scene scene = under({{{uniform_sky(), Spectrum(100.0)}, {below, Spectrum(30.0)}}, {}}, {ground});
    const Stage stage(scene);
    EXPECT_NEAR(light_at(stage, {0, 0, 1}, {0, 0, -1}, RegionId()),
                30 * (1 - 4 / pi * (5 / std::sqrt(26.0) * std::atan(5 / std::sqrt(26.0)))), 1e-9);
    // the ground is behind the receiver
    EXPECT_NEAR(light_at(stage, {100, 0, 50}, {1, 0, 0}, RegionId()), 50 + 15, 1e-9);
}

TEST(DistantLight, ThroughAnOpeningItAgreesWithTheReference) {
    // CIE 171, 5.9: a black room of 4 x 4 x 3 m with an opening of 1 x 1 m in its roof, the sun at 60 degrees in +y.
    const std::vector<Corners> room{{{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}},
                                    {{{0, 0, 0}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0}}},
                                    {{{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}}},
                                    {{{0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 0, 3}}},
                                    {{{4, 0, 0}, {4, 0, 3}, {4, 4, 3}, {4, 4, 0}}},
                                    {{{0, 0, 3}, {0, 1.5, 3}, {4, 1.5, 3}, {4, 0, 3}}},
                                    {{{0, 2.5, 3}, {0, 4, 3}, {4, 4, 3}, {4, 2.5, 3}}},
                                    {{{0, 1.5, 3}, {0, 2.5, 3}, {1.5, 2.5, 3}, {1.5, 1.5, 3}}},
                                    {{{2.5, 1.5, 3}, {2.5, 2.5, 3}, {4, 2.5, 3}, {4, 1.5, 3}}}};
    const Normal sun{0, 0.5, std::sqrt(0.75)};
    struct Known {
        int type;
        Point x;
        Normal n;
        double E;
    };
    for (const Known& k : {Known{1, {2, 0, 2.25}, {0, 1, 0}, 164.376254578},
                           {1, {2, 1.75, 0}, {0, 0, 1}, 429.385904561},
                           {12, {2, 0, 2.25}, {0, 1, 0}, 375.695655703},
                           {12, {2, 0, 1.25}, {0, 1, 0}, 460.939166455}}) {
        const Scene scene = under({{{cie_sky(k.type, sun), Spectrum(10000.0)}}, {}}, room);
        const Stage stage(scene);
        RegionId own;
        for (const RegionId r : scene.regions().ids())
            if (norm(scene.regions()[r].plane.n - k.n) < 1e-9 &&
                std::abs(scene.regions()[r].plane.signed_distance(k.x)) < 1e-9)
                own = r;
        EXPECT_NEAR(light_at(stage, k.x, k.n, own), k.E, 1e-3 * k.E) << k.type;
    }
}

TEST(DistantLight, TheSunThrowsUmbraAndPenumbra) {
    // Approximately a half plane, 4 m above the ground, with its edge along y at x = 0; the sun is at the zenith.
    const double E = 800, h = 4, radius = std::tan(sun_half_angle);
    const Scene scene = under({{}, {{{0, 0, 1}, sun_half_angle, Spectrum(E)}}},
                              {ground, {{{-4, -5, h}, {0, -5, h}, {0, 5, h}, {-4, 5, h}}}});
    const Stage stage(scene);
    EXPECT_EQ(light_at(stage, {-1.01 * radius * h, 0, 0}, {0, 0, 1}, first), 0);
    EXPECT_NEAR(light_at(stage, {1.01 * radius * h, 0, 0}, {0, 0, 1}, first), E, 1e-6 * E);
    for (double t = -0.95; t < 1; t += 0.1) {  // t: position across the penumbra, in radii of the disc
        const double lit = (std::acos(-t) + t * std::sqrt(1 - t * t)) / pi;
        EXPECT_NEAR(light_at(stage, {t * radius * h, 0.3, 0}, {0, 0, 1}, first), lit * E, 1e-3 * E) << t;
    }
}

TEST(DistantLight, ALowSunIsCutByTheHorizon) {
    const double E = 500;
    const Scene scene = under({{}, {{{1, 0, 0}, sun_half_angle, Spectrum(E)}}}, {ground});
    const Stage stage(scene);
    // Half of the disc is above the horizon: half of E times the mean height, 4 r / (3 pi).
    EXPECT_NEAR(light_at(stage, {0, 0, 0}, {0, 0, 1}, first), 0.5 * E * 4 * std::sin(sun_half_angle) / (3 * pi),
                1e-5 * E);
    EXPECT_NEAR(light_at(stage, {10, 0, 3}, {1, 0, 0}, RegionId()), E, 1e-9 * E);
}

}  // namespace exitance
