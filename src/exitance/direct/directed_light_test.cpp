#include <gtest/gtest.h>

#include <cmath>

#include "exitance/form_factors/directed_form_factor.hpp"
#include "exitance/scene/add_polygon.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// Light in two beams, one to each side of the vertical.
EmissionProfile batwing() {
    EmissionProfile p;
    p.body = EmissionProfile::Body::flat;
    p.axes[0] = {EmissionProfile::Angle::phi2, 0, {0, 45, 90, 135, 180}};
    p.axes[1] = {EmissionProfile::Angle::theta, 0, {0, 10, 20, 30, 40, 50, 60, 70, 80, 90}};
    for (const double phi : p.axes[0].at)
        for (const double theta : p.axes[1].at)
            p.values.push_back((1 + phi / 180) * std::cos(theta * pi / 180) *
                               (0.2 + std::pow(std::sin(2 * theta * pi / 180), 2)));
    return p;
}

/// A scene of these faces; the emitting ones have the profile, upright.
Scene make_directed(const std::vector<test::Face>& faces, const EmissionProfile& profile) {
    SceneDescription d;
    d.groups = {"all"};
    d.profiles = {profile};
    for (const test::Face& face : faces) {
        SceneDescription::Face& f = add_polygon(d, face.corners);
        f.material = static_cast<std::uint32_t>(d.materials.size());
        Material material{std::to_string(f.material), Spectrum(0.5), Spectrum(face.exitance)};
        if (face.exitance > 0) {
            const double flux = exitance_of(profile, normalized(area_vector(face.corners)));
            material.emission.profile = ProfileId(0), material.emission.scale = pi / flux;
        }
        d.materials.push_back(material);
    }
    CheckedScene checked = make_scene(std::move(d));
    EXPECT_TRUE(checked.scene) << checked.scene.error().message;
    return std::move(*checked.scene);
}

std::vector<Point> facing_down(double x0, double y0, double x1, double y1, double z) {
    return {{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}};
}

/// A room of 4 x 3 x 2.5 m with a lamp under its ceiling, and a shelf between the lamp and part of the floor.
std::vector<test::Face> lamp_room(double shelf) {
    std::vector<test::Face> faces = test::closed_box({0, 0, 0}, {4, 3, 2.5});
    faces.push_back({facing_down(1.7, 1.2, 2.3, 1.8, 2.3), 100});
    if (shelf > 0) {
        faces.push_back({facing_down(2, 1, 2 + shelf, 2, 1.2)});
        std::vector<Point> top = faces.back().corners;
        std::reverse(top.begin(), top.end());
        faces.push_back({top});
    }
    return faces;
}

TEST(DirectedLight, AllOfALampsFluxArrives) {
    const Scene scene = make_directed(lamp_room(0), batwing());
    const Occluders occluders(scene);
    const DirectLight direct(scene, occluders);
    VisibilityWorkspace scratch;
    double flux = 0;
    constexpr int cells = 40;
    for (std::uint32_t wall = 0; wall < 6; ++wall) {
        const auto corners = scene.outline(SurfaceId(wall));
        const Surface& surface = scene.surfaces()[SurfaceId(wall)];
        for (int i = 0; i < cells; ++i)
            for (int k = 0; k < cells; ++k) {
                const Point x = corners[0] + ((i + 0.5) / cells) * (corners[1] - corners[0]) +
                                ((k + 0.5) / cells) * (corners[3] - corners[0]);
                flux +=
                    direct.irradiance(x, surface.normal, surface.region, scratch)[0] * surface.area / (cells * cells);
            }
    }
    EXPECT_NEAR(flux, 36, 0.001 * 36);  // 100 W/m^2 of 0.36 m^2
}

TEST(DirectedLight, IsThatOfTheUnblockedPart) {
    const Scene scene = make_directed(lamp_room(1), batwing());
    const Occluders occluders(scene);
    const DirectLight direct(scene, occluders);
    VisibilityWorkspace scratch;
    const RelativeRadiance p = scene.relative_radiance(scene.surfaces()[SurfaceId(6)].region);
    ASSERT_TRUE(p.is_directed());
    std::size_t penumbra = 0;
    for (double x = 0.1; x < 4; x += 0.1) {
        // The shelf's shadow as seen from x starts where the line through the shelf's left edge meets the lamp; it
        // covers the whole range of y.
        const Point at{x, 1.5, 0};
        const double left = x + (2 - x) * 2.3 / 1.2, right = x + (3 - x) * 2.3 / 1.2;
        std::vector<std::pair<double, double>> lit = {{1.7, std::clamp(left, 1.7, 2.3)},
                                                      {std::clamp(right, 1.7, 2.3), 2.3}};
        double expected = 0;
        for (const auto& [x0, x1] : lit) {
            if (x1 - x0 < 1e-9) continue;
            std::vector<Vec3> corners;
            for (const Point& q : facing_down(x0, 1.2, x1, 1.8, 2.3)) corners.push_back(q - at);
            expected += 100 * directed_form_factor({0, 0, 1}, corners, p);
            penumbra += x1 - x0 < 0.599;
        }
        const double found = direct.irradiance(at, {0, 0, 1}, scene.surfaces()[SurfaceId(0)].region, scratch)[0];
        EXPECT_NEAR(found, expected, 1e-3 * expected) << x;
        ReceiverLight light;
        const std::vector<Point> about = {
            {x - 0.05, 1.45, 0}, {x + 0.05, 1.45, 0}, {x + 0.05, 1.55, 0}, {x - 0.05, 1.55, 0}};
        direct.prepare(about, {0, 0, 1}, scene.surfaces()[SurfaceId(0)].region, light, scratch);
        EXPECT_NEAR(direct.irradiance(light, at, scratch)[0], found, 1e-3 * found) << x;
    }
    EXPECT_GT(penumbra, 3u);
}

TEST(DirectedLight, SamplingByRaysIsUnbiased) {
    const Scene scene = make_directed(lamp_room(1), batwing());
    const Stage stage(scene);
    const ElementTree tree = stage.make_elements({0.25, 0});
    DirectFitRoom room;
    double exact = 0, found = 0;
    for (ElementId e : tree.leaves()) {
        exact += tree.area(e) * mean(fit_direct_light(stage, tree, e, 0, room).mean);
        const RayLight& rays = stage.place_light.rays();
        found += tree.area(e) * mean(rays.on_element(tree, e, Spectrum(1.0), HUGE_VAL, 256, room.place).irradiance);
    }
    EXPECT_NEAR(found / exact, 1, 0.015);
}

}  // namespace
}  // namespace exitance
