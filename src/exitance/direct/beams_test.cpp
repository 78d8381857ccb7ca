#include "exitance/direct/beams.hpp"

#include <gtest/gtest.h>

#include "exitance/transport/stage.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

using Kind = PunctualLight::Kind;

PunctualLight bulb(const Point& at, double intensity = 100) {
    PunctualLight light;
    light.position = at, light.intensity = Spectrum(intensity);
    return light;
}

test::Face square(double side, double z, double middle = 0) {
    const double a = middle - 0.5 * side, b = middle + 0.5 * side;
    return {{{a, a, z}, {b, a, z}, {b, b, z}, {a, b, z}}};
}

double floor_light(const Scene& scene, const PunctualLight& light, const Point& x) {
    const Occluders occluders(scene);
    const std::vector<PunctualLight> lights = {light};
    return Beams(lights, occluders).irradiance({x, {0, 0, 1}, scene.surfaces()[SurfaceId(0)].region})[0];
}

}  // namespace

TEST(Beams, ABulbOverAPlaneFollowsTheCubeOfTheCosine) {
    const Scene scene = test::make({square(10, 0)});
    for (const double a : {0.0, 0.5, 1.0, 3.0}) {
        const double r2 = 4 + a * a;  // the bulb is 2 m above
        EXPECT_NEAR(floor_light(scene, bulb({0, 0, 2}), {a, 0, 0}), 100 * 2 / (r2 * std::sqrt(r2)), 1e-12);
    }
    EXPECT_EQ(floor_light(scene, bulb({0, 0, -2}), {0, 0, 0}), 0) << "from below";
}

TEST(Beams, AShadowIsHardAndHasTheShapeOfTheBlocker) {
    // a square at half the height of the bulb: its shadow is 2 m wide
    const Scene scene = test::make({square(10, 0), square(1, 1)});
    EXPECT_EQ(floor_light(scene, bulb({0, 0, 2}), {1 - 1e-9, 0.3, 0}), 0);
    EXPECT_GT(floor_light(scene, bulb({0, 0, 2}), {1 + 1e-9, 0.3, 0}), 0);
    EXPECT_GT(floor_light(scene, bulb({0, 0, 1}), {0.2, 0.3, 0}), 0) << "a light in the blocker's plane";
}

TEST(Beams, NoLightLeaksThroughTheSeamsOfABlocker) {
    // Four adjacent squares; segments pass through their common corner and edges.
    std::vector<test::Face> faces = {square(10, 0)};
    for (const double x : {-1.0, 0.0})
        for (const double y : {-1.0, 0.0})
            faces.push_back({{{x, y, 1}, {x + 1, y, 1}, {x + 1, y + 1, 1.0}, {x, y + 1, 1}}, x + 3 * y + 5});
    const Scene scene = test::make(faces);
    for (int i = -10; i <= 10; ++i)
        for (int j = -10; j <= 10; ++j)
            EXPECT_EQ(floor_light(scene, bulb({0, 0, 2}), {0.17 * i, 0.1 * j, 0}), 0) << i << ' ' << j;
}

TEST(Beams, ASpotFallsOffBetweenItsCones) {
    const Scene scene = test::make({square(10, 0)});
    PunctualLight spot = bulb({0, 0, 2});
    spot.kind = Kind::spot, spot.inner_cone = 0.2, spot.outer_cone = 0.5;
    const double a = 2 * std::tan(0.35), r2 = 4 + a * a;
    const double t = (std::cos(0.35) - std::cos(0.5)) / (std::cos(0.2) - std::cos(0.5));
    EXPECT_NEAR(floor_light(scene, spot, {a, 0, 0}), 100 * t * t * 2 / (r2 * std::sqrt(r2)), 1e-12);
    EXPECT_EQ(floor_light(scene, spot, {2 * std::tan(0.51), 0, 0}), 0);
}

TEST(Beams, ParallelLightDoesNotFallOff) {
    const Scene scene = test::make({square(10, 0), square(1, 5)});
    PunctualLight sun;
    sun.kind = Kind::directional, sun.direction = {0.6, 0, -0.8}, sun.intensity = Spectrum(1000.0);
    EXPECT_NEAR(floor_light(scene, sun, {0, 2, 0}), 800, 1e-9);
    EXPECT_EQ(floor_light(scene, sun, {3.75, 0, 0}), 0) << "the blocker's shadow lies where the sun casts it";
}

TEST(Beams, APreparedReceiverHasTheSameLight) {
    std::vector<test::Face> faces = {square(2, -1)};
    for (const test::Face& face : test::triangle_soup(60, 0.4, 7, {0, 0, -0.3})) faces.push_back(face);
    const Scene scene = test::make(faces);
    const Occluders occluders(scene);
    PunctualLight sun;
    sun.kind = Kind::directional, sun.direction = normalized({0.3, -0.2, -1}), sun.intensity = Spectrum(3.0);
    const std::vector<PunctualLight> lights = {bulb({0.3, 0.2, 0.9}), bulb({-0.6, 0.1, -0.4}), sun};
    const Beams beams(lights, occluders);
    const RegionId own = scene.surfaces()[SurfaceId(0)].region;
    const Normal n = {0, 0, 1};
    RandomStream random(3, Stream::direct);
    std::size_t lit = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const double x = 1.6 * random.uniform() - 1, y = 1.6 * random.uniform() - 1, w = 0.02 + 0.3 * random.uniform();
        const std::vector<Point> part = {{x, y, -1}, {x + w, y, -1}, {x + w, y + w, -1}, {x, y + w, -1}};
        const std::vector<Point> inner = {part[0], 0.5 * (part[0] + part[1]), 0.5 * (part[0] + part[2])};
        std::vector<Beam> whole, some;
        std::vector<PieceId> candidates, fewer;
        beams.prepare(part, n, own, whole, candidates);
        beams.prepare(inner, n, own, whole, candidates, some, fewer);
        EXPECT_LE(fewer.size(), candidates.size());
        for (int k = 0; k < 10; ++k) {
            const double s = random.uniform(), t = random.uniform() * s;
            const SurfacePoint at{part[0] + (s * 0.5 * w) * Vec3{1, 0, 0} + (t * 0.5 * w) * Vec3{0, 1, 0}, n, own};
            const Spectrum exact = beams.irradiance(at);
            EXPECT_EQ(beams.irradiance(at, whole, candidates), exact);
            EXPECT_EQ(beams.irradiance(at, some, fewer), exact);
            lit += exact[0] > 3;  // brighter than the sun alone
        }
    }
    EXPECT_GT(lit, 300u) << "the test is to see both light and shadow";
    EXPECT_LT(lit, 1990u);
}

}  // namespace exitance
