// Light that the nodes of a rule can miss, compared with closed forms and graded quadrature.
#include "exitance/direct/small_sources.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/polygon.hpp"
#include "exitance/scene/sky/sun_position.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "support/checked_scene.hpp"

namespace exitance {
namespace {

/// A similarity: turned about an axis, scaled, then moved.
struct PlacedScene {
    double angle = 0, scale = 1;
    Vec3 move{};

    Vec3 turned(const Vec3& v) const {
        const Vec3 axis = normalized(Vec3{1, 2, 3});
        return std::cos(angle) * v + std::sin(angle) * cross(axis, v) + (1 - std::cos(angle)) * dot(axis, v) * axis;
    }
    Point operator()(const Point& p) const { return move + scale * turned(p); }
};

const std::vector<PlacedScene> placements{{}, {0.7, 1, {1000, -500, 30}}, {2, 1e-3, {}}, {-1, 1e3, {10, 0, 0}}};

constexpr double sun_irradiance = 700, sun_half_angle = 0.266 * pi / 180;

/// Faces of reflectance 0.5, lit by a sun and by a lamp without extent (if its intensity is not 0).
struct Description {
    std::vector<std::vector<Point>> faces;
    std::vector<double> exitances;
    Vec3 sun{};
    double intensity = 0;
    Point lamp{};
    std::vector<Pane> panes;

    void add(std::vector<Point> face, double exitance = 0) {
        faces.push_back(std::move(face)), exitances.push_back(exitance);
    }
    Scene placed(const PlacedScene& place) const {
        SceneDescription d;
        d.file = "small.obj", d.groups = {"all"};
        for (std::size_t i = 0; i < faces.size(); ++i) {
            const auto material = static_cast<std::uint32_t>(d.materials.size());
            d.materials.push_back({std::to_string(i), Spectrum(0.5), Spectrum(exitances[i])});
            add_polygon(d, faces[i], place).material = material;
        }
        if (norm(sun) > 0) d.distant.discs.push_back({place.turned(sun), sun_half_angle, Spectrum(sun_irradiance)});
        if (intensity > 0) {
            PunctualLight light;
            light.name = "lamp", light.position = place(lamp), light.intensity = Spectrum(intensity);
            d.lights.push_back(light);
        }
        for (Pane pane : panes) {
            for (Point& p : pane.corners) p = place(p);
            d.panes.push_back(pane);
        }
        return checked_scene(std::move(d));
    }
};

std::vector<Point> rectangle(double x0, double y0, double x1, double y1, double z) {
    return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

/// Ground of 10 x 10 m, and a screen 2 m above with a hole of 0.2 x 0.3 m.
Description ground_below_a_hole() {
    Description d;
    d.add(rectangle(-5, -5, 5, 5, 0));
    d.add(rectangle(-20, -20, 20, 1, 2)), d.add(rectangle(-20, 1.3, 20, 20, 2));
    d.add(rectangle(-20, 1, 1, 1.3, 2)), d.add(rectangle(1.2, 1, 20, 1.3, 2));
    return d;
}

/// Mean irradiance on the first face, without a rule: all light of small sources.
double mean_on_first_face(const Scene& scene) {
    const Occluders occluders(scene);
    const DirectLight direct(scene, occluders);
    SmallSources::Workspace room;
    const Surface& face = scene.surfaces()[SurfaceId(0)];
    const std::vector<Point> outline = [&] {
        const std::span<const Point> corners = occluders.corners(occluders.pieces(face.region).front());
        return std::vector<Point>(corners.begin(), corners.end());
    }();
    return SmallSources(direct).missed({outline, face.normal, face.region, {}, {}}, room).irradiance[0];
}

}  // namespace

TEST(SmallSources, AHoleLetsItsAreaOfSunlightThrough) {
    Description d = ground_below_a_hole();
    d.sun = sky_direction(50, 130);
    // Parallel light moves the outline of a horizontal hole without change. The polygon in place of the sun's disc and
    // the disc's cosines differ from parallel light by the square of its half angle, 2e-5.
    const double expected = sun_irradiance * d.sun.z * 0.06 / 100;
    for (const PlacedScene& place : placements)
        EXPECT_NEAR(mean_on_first_face(d.placed(place)), expected, 1e-4 * expected) << place.scale;
}

TEST(SmallSources, APaneInTheHoleDimsTheSunlight) {
    Description d = ground_below_a_hole();
    d.sun = sky_direction(50, 130);
    Pane pane;
    pane.corners = rectangle(1, 1, 1.2, 1.3, 2), pane.transmissivity = Spectrum(0.8);
    d.panes = {pane};
    pane.n = {0, 0, 1};
    const double expected = sun_irradiance * d.sun.z * 0.06 / 100 * pane.transmission(d.sun.z)[0];
    EXPECT_NEAR(mean_on_first_face(d.placed({})), expected, 1e-3 * expected);
}

TEST(SmallSources, ABarTakesItsAreaOfSunlightAway) {
    Description d;
    d.add(rectangle(-5, -5, 5, 5, 0));
    d.add(rectangle(-2, 0.3, 2, 0.31, 0.5));
    d.sun = sky_direction(50, 130);
    const double expected = sun_irradiance * d.sun.z * (1 - 0.04 / 100);
    for (const PlacedScene& place : placements)
        EXPECT_NEAR(mean_on_first_face(d.placed(place)), expected, 1e-4 * expected) << place.scale;
}

TEST(SmallSources, ALampWithoutExtentShinesThroughAHole) {
    Description d = ground_below_a_hole();
    d.intensity = 100, d.lamp = {1.1, 1.15, 3};
    // Solid angle of the hole, as seen from 1 m above its middle.
    const double a = 0.1, b = 0.15, omega = 4 * std::atan(a * b / std::sqrt(1 + a * a + b * b));
    for (const PlacedScene& place : placements)
        EXPECT_NEAR(mean_on_first_face(d.placed(place)), 100 * omega / (100 * place.scale * place.scale),
                    1e-3 * omega / (place.scale * place.scale))
            << place.scale;
}

TEST(SmallSources, ALampNearAWallLightsASpot) {
    // The wall is the first face; a lamp of 2 x 2 cm faces it at 3 cm.
    Description d;
    d.add(rectangle(-2, -1.5, 2, 1.5, 0));
    d.add({{0.41, 0.2, 0.03}, {0.41, 0.22, 0.03}, {0.43, 0.22, 0.03}, {0.43, 0.2, 0.03}}, 1e4);
    const Scene scene = d.placed({});
    const Stage stage(scene);
    DirectLight::Workspace workspace;
    // Quadrature whose points are as dense about the lamp as the light varies: x = x0 + 0.01 sinh(s).
    constexpr int steps = 300;
    const auto graded = [&](double lo, double hi, double middle, const auto& value) {
        const double s0 = std::asinh((lo - middle) / 0.01), s1 = std::asinh((hi - middle) / 0.01);
        double sum = 0;
        for (int i = 0; i < steps; ++i) {
            const double s = s0 + (i + 0.5) / steps * (s1 - s0);
            sum += value(middle + 0.01 * std::sinh(s)) * 0.01 * std::cosh(s) * (s1 - s0) / steps;
        }
        return sum;
    };
    const Surface& wall = scene.surfaces()[SurfaceId(0)];
    const double flux = graded(-2, 2, 0.42, [&](double x) {
        return graded(-1.5, 1.5, 0.21, [&](double y) {
            return stage.direct.irradiance({x, y, 0}, wall.normal, wall.region, workspace)[0];
        });
    });
    EXPECT_NEAR(flux, 4, 0.01);  // nearly all of the lamp's light
    // Error of the rule for light near a source: 1%.
    for (const PlacedScene& place : placements)
        EXPECT_NEAR(mean_on_first_face(d.placed(place)), flux / 12, 0.01 * flux / 12) << place.scale;
}

TEST(SmallSources, ProjectedLightHasTheFluxOfAPatchThatNoNodeSees) {
    for (const double x : {0.7, 1.1, 2.35}) {
        Description d = ground_below_a_hole();
        for (Point& p : d.faces[0]) p.x += x;  // the patch is in different places between the nodes
        d.sun = sky_direction(50, 130);
        const Scene scene = d.placed({});
        const Stage stage(scene);
        const StopRequest stop;
        const DirectProjection light =
            project_direct_light(stage, {.mesh = {5}, .tolerance = 0.05, .max_depth = 3}, stop);
        double flux = 0;
        for (ElementId e : light.tree.leaves())
            if (light.tree.region(e) == scene.surfaces()[SurfaceId(0)].region)
                flux += light.tree.area(e) * light.fit[e].mean[0];
        const double expected = sun_irradiance * d.sun.z * 0.06;
        // Elements of less than four penumbrae, 0.1 m, are left to their nodes; these are larger.
        EXPECT_NEAR(flux, expected, 1e-3 * expected) << x;
    }
}

}  // namespace exitance
