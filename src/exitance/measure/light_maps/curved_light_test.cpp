#include "exitance/measure/light_maps/curved_light.hpp"

#include <gtest/gtest.h>

#include "exitance/base/parallel.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/measure/light_maps/light_map.hpp"
#include "exitance/measure/light_maps/uv_light_map.hpp"
#include "support/built_scene.hpp"
#include "support/checked_scene.hpp"
#include "support/motion.hpp"
#include "support/solved.hpp"

namespace exitance {
namespace {

/// Triangles of a unit sphere: an octahedron split `depth` times.
std::vector<std::array<Point, 3>> sphere_triangles(int depth) {
    const Point x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    std::vector<std::array<Point, 3>> out{{x, y, z},  {y, -x, z},  {-x, -y, z},  {-y, x, z},
                                          {y, x, -z}, {-x, y, -z}, {-y, -x, -z}, {x, -y, -z}};
    for (; depth > 0; --depth) {
        std::vector<std::array<Point, 3>> split;
        for (const auto& [a, b, c] : out) {
            const Point ab = normalized(a + b), bc = normalized(b + c), ca = normalized(c + a);
            split.insert(split.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        out = std::move(split);
    }
    return out;
}

const std::vector<Point> lamp{{2.5, 0.5, 4}, {2.5, -0.5, 4}, {1.5, -0.5, 4}, {1.5, 0.5, 4}};

/// Triangles with normals at their corners, and a lamp above them.
struct CurvedScene {
    Scene scene;
    std::vector<NormalTriangle> triangles;
};

/// `normal(p)`: normal at a corner; `walls`: further grey polygons.
template <class NormalAt>
CurvedScene curved_scene(const std::vector<std::array<Point, 3>>& triangles, const NormalAt& normal,
                         const Motion& motion = as_written, const std::vector<std::vector<Point>>& walls = {},
                         const DistantLight& sky = {}) {
    SceneDescription d;
    d.distant = sky;
    d.file = "test.obj", d.groups = {"all"};
    d.materials = {{"grey", Spectrum(0.5), Spectrum()}, {"lamp", Spectrum(), Spectrum(8)}};
    const auto add = [&](const std::vector<Point>& corners) -> auto& {
        SceneDescription::Face& face = add_polygon(d, corners, motion);
        face.line = static_cast<int>(d.faces.size());
        return face;
    };
    for (const auto& t : triangles) add({t.begin(), t.end()});
    for (const auto& wall : walls) add(wall);
    add(lamp).material = 1;
    CurvedScene out{checked_scene(std::move(d)), {}};
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        NormalTriangle t{SurfaceId(i), {}, {}};
        for (std::size_t k = 0; k < 3; ++k)
            t.corner[k] = motion(triangles[i][k]), t.normal[k] = motion.turned(normal(triangles[i][k]));
        out.triangles.push_back(t);
    }
    return out;
}

CurvedScene sphere_scene(const Motion& motion = as_written, int depth = 3) {
    return curved_scene(
        sphere_triangles(depth), [](const Point& p) { return normalized(p); }, motion);
}

Solution quick_solution(const Scene& scene) {
    SolveOptions options;
    options.error = 0.1;
    return solved(scene, options);
}

LightMaps bake(const Solution& solution, const CurvedFaces* curved, double density,
               Component component = Component::total) {
    Progress progress;
    BakeOptions options;
    options.density = density, options.curved = curved, options.component = component;
    Result<LightMaps> maps = bake_light_maps(RadiosityFunction(solution), options, progress, StopRequest());
    EXI_CHECK(static_cast<bool>(maps));
    return std::move(*maps);
}

/// Light of the lamp at a point of the unit sphere before the motion.
double exact_light(const Point& p, const Motion& motion) {
    std::vector<Point> corners;
    for (const Point& c : lamp) corners.push_back(motion(c));
    const Normal n = normalized(p);
    return 8 * point_to_polygon(motion(n), motion.turned(n), corners);
}

/// RMS difference of a map from the exact light of the sphere, relative to its RMS.
double sphere_error(const LightMaps& light, std::size_t faces, const Motion& motion) {
    double squares = 0, level = 0;
    for (std::size_t c = 0; c < faces; ++c) {
        const Chart& chart = light.charts[c];
        for (int y = 0; y < chart.height; ++y)
            for (int x = 0; x < chart.width; ++x) {
                const LightMap& map = light.maps[chart.map];
                const std::size_t i = map.index(chart.x + x, chart.y + y);
                if (map.share[i] == 0) continue;
                const Vec3 d = (chart.at({x + 0.5, y + 0.5}) - motion.by) / motion.scale;
                const double exact = exact_light({dot(d, motion.u), dot(d, motion.v), dot(d, motion.n)}, motion);
                squares += static_cast<double>(map.share[i]) * std::pow(mean(map.at(i)) - exact, 2);
                level += static_cast<double>(map.share[i]) * exact * exact;
            }
    }
    return std::sqrt(squares / level);
}

TEST(CurvedFaces, PatchesOfASphereFollowIt) {
    const CurvedScene s = sphere_scene();
    const CurvedFaces faces(s.scene, s.triangles);
    ASSERT_EQ(faces.triangles().size(), 512u);
    double farthest = 0;
    for (std::size_t t = 0; t < 512; ++t)
        for (int i = 0; i <= 4; ++i)
            for (int j = 0; i + j <= 4; ++j) {
                const CurvedPlace place = faces.at(t, {1 - 0.25 * (i + j), 0.25 * i, 0.25 * j});
                farthest = std::max(farthest, std::abs(norm(place.x) - 1));
                // Normals that are linear on the face are those of the sphere.
                EXPECT_NEAR(norm(place.n - normalized(place.x)), 0, 1e-3);
            }
    // The faces are up to 0.013 inside. The error of a cubic patch falls with the fourth power of its angle of 0.2.
    EXPECT_LT(farthest, 5e-4);
}

TEST(CurvedFaces, ConcavePatchesStayOnTheFaces) {
    std::vector<std::array<Point, 3>> inside = sphere_triangles(2);
    for (auto& t : inside) std::swap(t[1], t[2]);
    const CurvedScene s = curved_scene(inside, [](const Point& p) { return -1 * normalized(p); });
    const CurvedFaces faces(s.scene, s.triangles);
    ASSERT_FALSE(faces.empty());
    for (std::size_t t = 0; t < faces.triangles().size(); ++t) {
        const CurvedPlace place = faces.at(t, {0.2, 0.5, 0.3});
        const auto& c = faces.triangles()[t].corner;
        EXPECT_NEAR(norm(place.x - (0.2 * c[0] + 0.5 * c[1] + 0.3 * c[2])), 0, 1e-12);
    }
}

TEST(CurvedFaces, SurfacesWithNormalsOfTheirFacesOrCoarseOnesAreFlat) {
    const std::vector<std::array<Point, 3>> octahedron = sphere_triangles(0);
    const CurvedScene coarse = curved_scene(octahedron, [](const Point& p) { return p; });
    EXPECT_TRUE(CurvedFaces(coarse.scene, coarse.triangles).empty());  // normals are 54.7 degrees off
    CurvedScene split = sphere_scene();
    for (NormalTriangle& t : split.triangles) t.normal.fill(split.scene.surfaces()[t.surface].normal);
    EXPECT_TRUE(CurvedFaces(split.scene, split.triangles).empty());
    EXPECT_TRUE(CurvedFaces(split.scene, {}).empty());
}

TEST(CurvedLight, TheMapOfASphereIsThatOfTheExactSphere) {
    for (const Motion& motion : {as_written, turned_and_moved}) {
        const CurvedScene s = sphere_scene(motion);
        const Solution solution = quick_solution(s.scene);
        const CurvedFaces faces(solution.scene, s.triangles);
        const LightMaps curved = bake(solution, &faces, 24 / motion.scale),
                        faceted = bake(solution, nullptr, 24 / motion.scale);
        // At most 3% error is required. Places on the chords would cause 1%; those on the curved patches leave only
        // the errors of texels and rounding.
        EXPECT_LT(sphere_error(curved, 512, motion), 0.005);
        EXPECT_GT(sphere_error(faceted, 512, motion), 0.05);
        ASSERT_EQ(curved.curved.regions.size(), 512u);
        EXPECT_GT(curved.curved.rms(), 0.005);
        EXPECT_LT(curved.curved.rms(), 0.1);  // the faces' tilt and the solve's error
    }
}

TEST(CurvedLight, AFileWithoutNormalsChangesNoBits) {
    const CurvedScene s = sphere_scene(as_written, 1);
    const Solution solution = quick_solution(s.scene);
    const CurvedFaces none;
    const LightMaps a = bake(solution, nullptr, 16), b = bake(solution, &none, 16);
    ASSERT_EQ(a.maps.size(), b.maps.size());
    EXPECT_EQ(a.maps[0].irradiance, b.maps[0].irradiance);
    EXPECT_TRUE(b.curved.empty());
}

/// A wall 1 mm in front of the top of the sphere, between it and the lamp: no light may pass it, although the patches
/// are up to 13 mm above their faces.
TEST(CurvedLight, NoLightLeaksThroughAWallInFrontOfAPatch) {
    const std::vector<Point> wall{{-5, -5, 0.99}, {5, -5, 0.99}, {5, 5, 0.99}, {-5, 5, 0.99}};
    std::vector<std::array<Point, 3>> below;
    for (const auto& t : sphere_triangles(3))
        if (std::max({t[0].z, t[1].z, t[2].z}) < 0.985) below.push_back(t);
    const std::vector<Point> other_side(wall.rbegin(), wall.rend());
    const CurvedScene s =
        curved_scene(below, [](const Point& p) { return normalized(p); }, as_written, {wall, other_side});
    const Solution solution = quick_solution(s.scene);
    const CurvedFaces faces(solution.scene, s.triangles);
    ASSERT_FALSE(faces.empty());
    const RadiosityFunction light(solution);
    const StopRequest stop;
    const CurvedLight curved(light, faces, 1, stop);
    CurvedLight::Workspace workspace;
    for (const NormalTriangle& t : faces.triangles()) {
        const Region& region = solution.scene.regions()[solution.scene.surfaces()[t.surface].region];
        const MeasuredPlace middle = light.places().find((t.corner[0] + t.corner[1] + t.corner[2]) / 3, region.plane.n);
        ASSERT_EQ(middle.surface, t.surface);
        // All light is at the far side of the wall, except for that which passes around it, 5 m away.
        EXPECT_LT(mean(curved.mean_at(std::span(&middle, 1), false, Component::total, workspace).irradiance), 0.02);
    }
}

TEST(CurvedLight, MapsHaveTheSameBitsOnAnyNumberOfThreads) {
    const CurvedScene s = sphere_scene(as_written, 2);
    const Solution solution = quick_solution(s.scene);
    const CurvedFaces faces(solution.scene, s.triangles);
    set_threads(1);
    const LightMaps one = bake(solution, &faces, 16);
    set_threads(3);
    const LightMaps three = bake(solution, &faces, 16);
    set_threads(0);
    EXPECT_EQ(one.maps[0].irradiance, three.maps[0].irradiance);
}

/// A sphere above a square floor of uniform radiosity, 2 W/m^2.
struct SphereAboveFloor {
    CurvedScene scene;
    Solution solution;

    /// `size`: half the side of the floor, m.
    explicit SphereAboveFloor(double size)
        : scene(curved_scene(sphere_triangles(3), [](const Point& p) { return normalized(p); }, as_written,
                             {{{-size, -size, -1.5}, {size, -size, -1.5}, {size, size, -1.5}, {-size, size, -1.5}}})),
          solution(quick_solution(scene.scene)) {
        const RegionId below = solution.scene.surfaces()[SurfaceId(512)].region;
        ElementFunction& light = solution.interpolant;
        for (ElementId e : light.tree.leaves()) {
            const auto corners = static_cast<std::uint32_t>(light.tree.patch(e).corner_count());
            for (std::uint32_t k = 0; k < corners; ++k)
                light.values[light.first_value[e] + k].fill(light.tree.region(e) == below ? 2.f : 0.f);
        }
    }
};

/// Above a wide floor the analytic irradiance of the sphere is B (1 - cos) / 2.
TEST(CurvedLight, ReflectedLightIsThatOfTheSmoothNormal) {
    const SphereAboveFloor s(200);
    const CurvedFaces faces(s.solution.scene, s.scene.triangles);
    const RadiosityFunction function(s.solution);
    const StopRequest stop;
    const CurvedLight curved(function, faces, 1, stop);
    CurvedLight::Workspace workspace;
    double squares = 0;
    for (const NormalTriangle& t : faces.triangles()) {
        const Normal& n = s.solution.scene.surfaces()[t.surface].normal;
        const Point middle = (t.corner[0] + t.corner[1] + t.corner[2]) / 3;
        const MeasuredPlace place = function.places().find(middle, n);
        const Normal smooth = normalized(middle);
        const double E = mean(curved.mean_at(std::span(&place, 1), false, Component::total, workspace).irradiance) -
                         exact_light(middle, as_written);
        squares += std::pow(E - 0.5 * 2 * (1 - smooth.z) / 2, 2);
    }
    // Irradiance is from 0 to 1. Rays leave 0.3%, and the sum over nodes interpolates it by 0.2%; the horizon of a
    // floor of 200 m is at 0.4 degrees.
    EXPECT_LT(std::sqrt(squares / 512), 0.006);
}

TEST(CurvedLight, DirectAndIndirectMapsAddUpToThatOfAllLight) {
    const SphereAboveFloor s(4);
    const CurvedFaces faces(s.solution.scene, s.scene.triangles);
    const LightMaps all = bake(s.solution, &faces, 16), direct = bake(s.solution, &faces, 16, Component::direct),
                    indirect = bake(s.solution, &faces, 16, Component::indirect);
    EXPECT_FALSE(all.curved.empty());
    EXPECT_TRUE(direct.curved.empty());
    double reflected = 0;
    for (std::size_t c = 0; c < 512; ++c) {
        const Chart& chart = all.charts[c];
        const LightMap& map = all.maps[chart.map];
        for (int y = 0; y < chart.height; ++y)
            for (int x = 0; x < chart.width; ++x) {
                const std::size_t i = map.index(chart.x + x, chart.y + y);
                if (map.share[i] < 1) continue;  // light at borders is extrapolated to the centre, with limits
                const double D = mean(direct.maps[chart.map].at(i)), I = mean(indirect.maps[chart.map].at(i));
                EXPECT_NEAR(D + I, mean(map.at(i)), 1e-5 * (D + I));
                reflected = std::max(reflected, I);
            }
    }
    // The floor fills 98.5% of what the lowest point sees, and that point reflects nothing itself.
    EXPECT_NEAR(reflected, 1, 0.05);
}

/// Two spheres side by side block the sky from each other, so that their light is that of rays.
TEST(CurvedLight, NoiseOfRaysNeedsNoFurtherPlaces) {
    std::vector<std::array<Point, 3>> triangles = sphere_triangles(3);
    const Vec3 shift{2.3, 0, 0};
    for (std::size_t i = 0; i < 512; ++i) {
        const auto [a, b, c] = triangles[i];
        triangles.push_back({a + shift, b + shift, c + shift});
    }
    const auto normal = [&](const Point& p) { return normalized(norm(p) < 1.001 ? p : p - shift); };
    DistantLight sky;
    sky.domes.push_back({{}, Spectrum(100)});
    const CurvedScene s = curved_scene(triangles, normal, as_written, {}, sky);
    Solution solution = quick_solution(s.scene);
    solution.statistics.relative_error_estimate = 0.05;  // the rays of the bake may have a fifth of this error
    const CurvedFaces faces(solution.scene, s.triangles);
    const RadiosityFunction function(solution);
    const StopRequest stop;
    const CurvedLight curved(function, faces, 1, stop);
    CurvedLight::Workspace workspace;
    std::size_t noisy = 0, places = 0;
    for (std::size_t t = 0; t < 512; ++t) {
        const NormalTriangle& face = faces.triangles()[t];
        const Point middle = (face.corner[0] + face.corner[1] + face.corner[2]) / 3;
        std::vector<MeasuredPlace> close;
        double least = HUGE_VAL, most = 0;
        for (int k = 0; k < 16; ++k) {
            const Point x =
                middle + 1e-3 * (k % 4) * (face.corner[0] - middle) + 1e-3 * (k / 4) * (face.corner[1] - middle);
            close.push_back(function.places().find(x, solution.scene.surfaces()[face.surface].normal));
            if (k >= 4) continue;
            const auto [E, count] = curved.mean_at(std::span(&close.back(), 1), false, Component::total, workspace);
            least = std::min(least, mean(E)), most = std::max(most, mean(E));
        }
        if (most - least < 0.01 * most) continue;  // certainly alike
        ++noisy, places += curved.mean_at(close, true, Component::total, workspace).places;
    }
    ASSERT_GT(noisy, 30u);
    EXPECT_LT(places, 5 * noisy) << "of 16 places per texel";
}

}  // namespace
}  // namespace exitance
