// Light through panes of clear glass, exact and by rays.
#include <gtest/gtest.h>

#include <cmath>

#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/scene/sky/sun_position.hpp"
#include "exitance/transport/stage.hpp"
#include "support/checked_scene.hpp"

namespace exitance {
namespace {

Pane clear_pane(std::vector<Point> corners, const Spectrum& transmissivity) {
    Pane out;
    out.corners = std::move(corners), out.transmissivity = transmissivity;
    return out;
}

/// Ground of 2 x 2 m under panes and light.
Scene ground_under(const DistantLight& light, std::vector<Pane> panes) {
    SceneDescription d;
    d.file = "glass.obj";
    d.materials = {{"grey", Spectrum(0.5), {}}};
    d.groups = {"all"};
    d.points = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    d.faces.push_back({{0, 1, 2, 3}, 0, 0, 0});
    d.distant = light, d.panes = std::move(panes);
    return checked_scene(std::move(d));
}

std::vector<Point> level_square(double half, double z, double x0 = 0) {
    return {{x0 - half, -half, z}, {x0 + half, -half, z}, {x0 + half, half, z}, {x0 - half, half, z}};
}

/// Mean of `share` for diffuse light: 2 int share(cos) sin cos dtheta.
template <class Share>
double of_diffuse_light(const Share& share) {
    constexpr int steps = 4000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double theta = (i + 0.5) * 0.5 * pi / steps;
        sum += share(std::cos(theta)) * std::sin(2 * theta);
    }
    return sum * 0.5 * pi / steps;
}

double diffuse(const Pane& p, std::size_t band) {
    return of_diffuse_light([&](double cosine) { return p.transmission(cosine)[band]; });
}

/// Cosine-distributed directions upwards.
std::vector<Vec3> directions_up(std::uint32_t rays) {
    const ScrambledSobol points(5);
    const Frame frame(Normal{0, 0, 1});
    std::vector<Vec3> out;
    for (std::uint32_t i = 0; i < rays; ++i) out.push_back(cosine_direction(frame, points(i, 0), points(i, 1)));
    return out;
}

const RegionId own(0);

}  // namespace

TEST(GlazedLight, AWidePaneLetsTheDiffuseShareOfASkyThrough) {
    Spectrum tint;
    for (std::size_t b = 0; b < bands; ++b) tint[b] = 0.96 - 0.2 * static_cast<double>(b);
    const Pane wide = clear_pane(level_square(1000, 0.5), tint);
    const Scene scene = ground_under({{{uniform_sky(), Spectrum(100.0)}}, {}}, {wide});
    const Stage stage(scene);
    DirectLight::Workspace workspace;
    const Spectrum E = stage.direct.irradiance({0.1, 0.2, 0}, {0, 0, 1}, own, workspace);
    for (std::size_t b = 0; b < bands; ++b) EXPECT_NEAR(E[b], 100 * diffuse(wide, b), 0.2) << b;
    ReceiverLight light;
    stage.direct.prepare(std::vector<Point>{{0, 0, 0}, {0.2, 0, 0}, {0.2, 0.4, 0}, {0, 0.4, 0}}, {0, 0, 1}, own, light,
                         workspace);
    EXPECT_NEAR(stage.direct.irradiance(light, {0.1, 0.2, 0}, workspace)[0], E[0], 1e-9);
}

TEST(GlazedLight, TheSameShareOfRaysPasses) {
    const Pane wide = clear_pane(level_square(1000, 0.5), Spectrum(0.7));
    const Scene scene = ground_under({}, {wide});
    const Stage stage(scene);
    constexpr std::uint32_t rays = 1 << 14;
    const std::vector<Vec3> directions = directions_up(rays);
    std::vector<RayHit> hits(rays), again(rays);
    stage.tracer.nearest(directions, {0.1, 0.2, 0}, own, hits);
    stage.tracer.nearest(directions, {0.1, 0.2, 0}, own, again);
    double passed = 0;
    for (std::size_t i = 0; i < rays; ++i) {
        passed += hits[i].surface.is_none();
        if (!hits[i].surface.is_none()) {
            EXPECT_FALSE(hits[i].front);
        }
        EXPECT_EQ(hits[i].surface, again[i].surface);
    }
    EXPECT_NEAR(passed / rays, diffuse(wide, 0), 4 * 0.5 / std::sqrt(rays));
}

TEST(GlazedLight, TheReflectedShareOfRaysArrivesAtTheMirroredPoints) {
    // Ground below a low pane that is wider: mirrored rays return to the ground, whose border is at x = y = +-1.
    const Pane wide = clear_pane(level_square(1000, 0.25), Spectrum(0.7));
    const Scene scene = ground_under({}, {wide});
    const Stage stage(scene);
    constexpr std::uint32_t rays = 1 << 14;
    const std::vector<Vec3> directions = directions_up(rays);
    std::vector<RayHit> hits(rays);
    const Point from{0.1, 0.2, 0};
    stage.tracer.nearest(directions, from, own, hits, Mirrored::followed);
    double mirrored = 0;
    for (std::size_t i = 0; i < rays; ++i) {
        if (hits[i].mirror < 0) continue;
        mirrored += 1;
        const Vec3 w = arriving(scene, hits[i], directions[i]);
        EXPECT_EQ(w, (Vec3{directions[i].x, directions[i].y, -directions[i].z}));
        const double way = 0.5 / directions[i].z;
        const Point there = from + way * Vec3{directions[i].x, directions[i].y, 0};
        const bool on_ground = std::max(std::abs(there.x), std::abs(there.y)) < 1;
        if (std::abs(std::max(std::abs(there.x), std::abs(there.y)) - 1) > 1e-5) {
            EXPECT_EQ(hits[i].front && !hits[i].surface.is_none(), on_ground);
        }
        if (hits[i].surface.is_none()) continue;
        EXPECT_NEAR(hits[i].distance, way, 1e-5 * way);
        EXPECT_LT(norm(place_of(scene, hits[i], from, directions[i]) - there), 1e-5 * way);
    }
    const double sum = of_diffuse_light([&](double cosine) { return wide.reflection(cosine)[0]; });
    EXPECT_NEAR(mirrored / rays, sum, 4 * std::sqrt(sum / rays));
}

TEST(GlazedLight, TheSunThroughOnePaneOfTwo) {
    const Normal sun = sky_direction(50, 90);  // +x
    const DistantLight light{{}, {{sun, sun_half_angle, Spectrum(700.0)}}};
    const Pane low = clear_pane(level_square(0.5, 0.2), Spectrum(0.8)),
               high = clear_pane(level_square(0.3, 0.4), Spectrum(0.6));
    const Scene scene = ground_under(light, {low, high});
    const Stage stage(scene);
    DirectLight::Workspace workspace;
    const double E = 700 * sun.z, cosine = sun.z;
    const auto at = [&](double x) { return stage.direct.irradiance({x, 0, 0}, {0, 0, 1}, own, workspace)[0]; };
    EXPECT_NEAR(at(-0.9), E, 1e-4 * E);
    EXPECT_NEAR(at(0.2), E * low.transmission(cosine)[0], 1e-3 * E);
    EXPECT_NEAR(at(-0.3), E * low.transmission(cosine)[0] * high.transmission(cosine)[0], 1e-3 * E);
    // On the edge of the lower pane's shadow, half of the disc is behind the pane.
    EXPECT_NEAR(at(0.5 - 0.2 * sun.x / sun.z), 0.5 * E * (1 + low.transmission(cosine)[0]), 2e-3 * E);
}

}  // namespace exitance
