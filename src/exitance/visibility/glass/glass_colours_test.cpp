#include "exitance/visibility/glass/glass_colours.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

/// Counts of rays from a place below a coloured pane, times their colours, against the pane's transmission and
/// reflection in every band.
TEST(GlassColours, BandsOfRaysAreRightInTheMean) {
    SceneDescription d;
    d.file = "glass.obj";
    d.materials = {{"grey", Spectrum(0.5), {}}};
    d.groups = {"all"};
    d.points = {{-9, -9, 2}, {-9, 9, 2}, {9, 9, 2}, {9, -9, 2}, {-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 0}, {{4, 5, 6, 7}, 0, 0, 0}};
    Pane pane;
    pane.corners = {{-9, -9, 1}, {9, -9, 1}, {9, 9, 1}, {-9, 9, 1}};
    pane.transmissivity = Spectrum(0.2), pane.transmissivity[0] = 0.95;
    d.panes = {pane};
    CheckedScene checked = make_scene(std::move(d));
    ASSERT_TRUE(static_cast<bool>(checked.scene));
    const Scene& scene = *checked.scene;
    const RayTracer tracer(scene);
    const GlassColours colours(scene);
    ASSERT_FALSE(colours.empty());
    constexpr std::size_t rays = 1 << 15;
    for (const double cosine : {1.0, 0.5}) {
        const double sine = std::sqrt(1 - cosine * cosine);
        std::vector<Vec3> directions(rays);
        const ScrambledSobol points(7);
        for (std::uint32_t i = 0; i < rays; ++i) {
            const double angle = 2 * pi * points(i, 0);
            directions[i] = {sine * std::cos(angle), sine * std::sin(angle), cosine};
            directions[i] = (1 + points(i, 1)) * directions[i];  // the fate of a ray depends on its direction
        }
        std::vector<RayHit> hits(rays);
        const Point x{0.1, 0.2, 0.5};
        tracer.nearest(directions, x, RegionId(), hits, Mirrored::followed);
        Spectrum through, back;
        for (std::size_t i = 0; i < rays; ++i) {
            if (!hits[i].front) continue;
            (hits[i].mirror < 0 ? through : back) += colours.of(hits[i], x, directions[i]) / static_cast<double>(rays);
        }
        const double noise = 4 / std::sqrt(static_cast<double>(rays));
        for (std::size_t b = 0; b < bands; ++b) {
            EXPECT_NEAR(through[b], scene.panes()[0].transmission(cosine)[b], noise) << cosine << ", " << b;
            EXPECT_NEAR(back[b], scene.panes()[0].reflection(cosine)[b], noise) << cosine << ", " << b;
        }
    }
}

TEST(GlassColours, ARayIsColouredBeforeAndAfterItIsMirrored) {
    SceneDescription d;
    d.file = "glass.obj";
    d.materials = {{"grey", Spectrum(0.5), {}}};
    d.groups = {"all"};
    d.points = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 0}};
    Spectrum tint(0.2);
    tint[0] = 0.9;
    Pane upright, mirror;
    upright.corners = {{1, -9, 0}, {1, 9, 0}, {1, 9, 9}, {1, -9, 9}}, upright.transmissivity = tint;
    mirror.corners = {{-9, -9, 5}, {9, -9, 5}, {9, 9, 5}, {-9, 9, 5}}, mirror.transmissivity = Spectrum(0.5);
    d.panes = {upright, mirror};
    const CheckedScene checked = make_scene(std::move(d));
    ASSERT_TRUE(static_cast<bool>(checked.scene));
    const Scene& scene = *checked.scene;
    RayHit hit;  // from (0, 0, 1) up to the mirror at (x, 0, 5), and down to the floor
    hit.surface = SurfaceId(0), hit.region = scene.surfaces()[SurfaceId(0)].region, hit.front = true, hit.mirror = 1;
    hit.distance = 9;
    for (const double slope : {0.2, 0.5}) {  // crosses x = 1 after the mirror, or before
        const Spectrum found = GlassColours(scene).of(hit, {0, 0, 1}, {slope, 0, 1});
        const Spectrum T = scene.panes()[0].transmission(slope / std::sqrt(1 + slope * slope));
        for (std::size_t b = 0; b < bands; ++b) EXPECT_NEAR(found[b], T[b] / mean(T), 1e-12) << slope << ", " << b;
    }
}

TEST(GlassColours, APieceOfARayHasTheColoursOfThePanesBetweenItsEnds) {
    SceneDescription d;
    d.file = "glass.obj";
    d.materials = {{"grey", Spectrum(0.5), {}}};
    d.groups = {"all"};
    d.points = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
    d.faces = {{{0, 1, 2, 3}, 0, 0, 0}};
    for (std::size_t i = 0; i < 3; ++i) {  // two panes of different colours, and a grey one
        const double z = 1 + static_cast<double>(i);
        Pane pane;
        pane.corners = {{-9, -9, z}, {9, -9, z}, {9, 9, z}, {-9, 9, z}}, pane.transmissivity = Spectrum(0.3);
        if (i < 2) pane.transmissivity[i] = 0.9;
        d.panes.push_back(pane);
    }
    const CheckedScene checked = make_scene(std::move(d));
    ASSERT_TRUE(static_cast<bool>(checked.scene));
    const Scene& scene = *checked.scene;
    const GlassColours colours(scene);
    const Vec3 w = normalized(Vec3{0.3, -0.2, 1});
    Spectrum of_pane[2];
    for (std::size_t i = 0; i < 2; ++i) {
        const Spectrum T = scene.panes()[i].transmission(w.z);
        of_pane[i] = T / mean(T);
    }
    const auto at = [&](double z) { return Point{0.1, 0.2, 0} + z / w.z * w; };
    for (std::size_t b = 0; b < bands; ++b) {
        EXPECT_NEAR(colours.between(at(0.5), at(3.5))[b], of_pane[0][b] * of_pane[1][b], 1e-12) << b;
        EXPECT_NEAR(colours.between(at(0.5), at(1.5))[b], of_pane[0][b], 1e-12) << b;
        EXPECT_NEAR(colours.between(at(3.5), at(1.5))[b], of_pane[1][b], 1e-12) << b;
        EXPECT_NEAR(colours.between(at(0.2), at(0.8))[b], 1, 1e-12) << b;
    }
}

TEST(GlassColours, GreyPanesGiveNone) {
    SceneDescription d;
    d.file = "glass.obj";
    d.materials = {{"grey", Spectrum(0.5), {}}};
    d.groups = {"all"};
    d.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
    d.faces = {{{0, 1, 2}, 0, 0, 0}};
    Pane pane;
    pane.corners = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}}, pane.transmissivity = Spectrum(0.5);
    d.panes = {pane};
    const CheckedScene checked = make_scene(std::move(d));
    ASSERT_TRUE(static_cast<bool>(checked.scene));
    const GlassColours colours(*checked.scene);
    EXPECT_TRUE(colours.empty());
    EXPECT_EQ(colours.between({0.5, 0.2, 0}, {0.5, 0.2, 2})[0], 1);
}

}  // namespace
}  // namespace exitance
