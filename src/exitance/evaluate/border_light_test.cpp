#include <gtest/gtest.h>

#include <array>

#include "exitance/evaluate/surface_levels.hpp"
#include "exitance/measure/measuring_grid.hpp"
#include "exitance/reference/path_reference.hpp"
#include "exitance/scene/add_polygon.hpp"
#include "support/sample_solution.hpp"

namespace exitance {
namespace {

/// A rotation, a scale and a translation.
struct Motion {
    std::array<Vec3, 3> rows{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    double scale = 1;
    Vec3 shift = {};

    Vec3 turned(const Vec3& d) const { return {dot(rows[0], d), dot(rows[1], d), dot(rows[2], d)}; }
    Point operator()(const Point& p) const { return scale * turned(p) + shift; }
};

/// A room of 4 x 3 x 2.5 m without a ceiling, with lamps above and beside it, a point light beside it, and a sheet that
/// is upright on its floor in the plane x = 2, y < 1.
Scene open_room(const Motion& motion = {}) {
    SceneDescription d;
    d.materials = {{"wall", Spectrum(0.5), {}}, {"lamp", {}, Spectrum(50)}};
    d.groups = {"all"};
    const auto face = [&](const std::vector<Point>& corners, std::uint32_t material) {
        add_polygon(d, corners, motion).material = material;
    };
    face({{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}}, 0);
    face({{0, 0, 0}, {0, 3, 0}, {0, 3, 2.5}, {0, 0, 2.5}}, 0);
    face({{4, 0, 0}, {4, 0, 2.5}, {4, 3, 2.5}, {4, 3, 0}}, 0);
    face({{0, 0, 0}, {0, 0, 2.5}, {4, 0, 2.5}, {4, 0, 0}}, 0);
    face({{0, 3, 0}, {4, 3, 0}, {4, 3, 2.5}, {0, 3, 2.5}}, 0);
    face({{2, 0, 0}, {2, 1, 0}, {2, 1, 2}, {2, 0, 2}}, 0);
    face({{2, 0, 0}, {2, 0, 2}, {2, 1, 2}, {2, 1, 0}}, 0);
    face({{-3, -3, 4}, {-3, 6, 4}, {5, 6, 4}, {5, -3, 4}}, 1);  // emits downwards
    face({{-1, 0, 1}, {-1, 3, 1}, {-1, 3, 3}, {-1, 0, 3}}, 1);  // this face emits towards the room
    d.lights = {{"bulb",
                 PunctualLight::Kind::point,
                 motion({-1, 1, 2}),
                 {0, 0, -1},
                 Spectrum(100 * motion.scale * motion.scale)}};
    CheckedScene made = make_scene(std::move(d));
    EXI_CHECK(static_cast<bool>(made.scene));
    return std::move(*made.scene);
}

/// Solution with direct light only.
Solution direct_light(Scene scene) {
    Solution s = even_solution(std::move(scene), 0);
    s.bounces = 0;
    return s;
}

constexpr double step_inside = 1e-4;  ///< Metres; over this distance light changes by less than 1e-3.

/// Points on borders, each with a point at the distance `step_inside`.
struct Pair {
    ProbePoint on, beside;
};
std::vector<Pair> border_points() {
    const Normal up{0, 0, 1}, right{1, 0, 0}, back{0, 1, 0};
    return {{{{0, 1.5, 0}, up}, {{step_inside, 1.5, 0}, up}},  // point below a wall
            {{{4, 1.5, 0}, up}, {{4 - step_inside, 1.5, 0}, up}},
            {{{1, 0, 0}, up}, {{1, step_inside, 0}, up}},
            {{{0, 0, 0}, up}, {{step_inside, step_inside, 0}, up}},  // point in a corner of three faces
            {{{4, 3, 0}, up}, {{4 - step_inside, 3 - step_inside, 0}, up}},
            {{{2 + 1e-7, 0.5, 0}, up}, {{2 + step_inside, 0.5, 0}, up}},  // point below the sheet
            {{{2 - 1e-7, 0.5, 0}, up}, {{2 - step_inside, 0.5, 0}, up}},
            {{{0, 1, 0}, right}, {{0, 1, step_inside}, right}},  // point at the foot of a wall
            {{{0, 0, 1}, right}, {{0, step_inside, 1}, right}},  // point in the corner of two walls
            {{{0, 0, 1}, back}, {{step_inside, 0, 1}, back}},
            {{{0, 1.5, 0.8}, up}, {{step_inside, 1.5, 0.8}, up}},  // point in free space, in the plane of a wall
            {{{0, 0, 0.8}, up}, {{step_inside, step_inside, 0.8}, up}},
            {{{2, 0.5, 2}, up}, {{2, 0.5, 2 + step_inside}, up}}};  // point on the upper edge of the sheet
}

TEST(BorderLight, IsTheLimitFromTheSideOfThePoint) {
    const Solution s = direct_light(open_room());
    const RadiosityFunction light(s);
    for (const auto& [on, beside] : border_points()) {
        const std::vector<Light> found = light.at(std::array{on, beside});
        ASSERT_GT(found[1].irradiance[0], 0.1);
        EXPECT_NEAR(found[0].irradiance[0] / found[1].irradiance[0], 1, 1e-3)
            << on.x.x << ' ' << on.x.y << ' ' << on.x.z;
        EXPECT_EQ(found[0].on_surface, found[1].on_surface);
    }
}

TEST(BorderLight, IsInvariantUnderRotationTranslationAndScaling) {
    const Frame odd(normalized(Vec3{0.3, -0.5, 0.71}));
    const std::vector<Motion> motions{{{Vec3{0, -1, 0}, Vec3{1, 0, 0}, Vec3{0, 0, 1}}},
                                      {{odd.u, odd.v, odd.n}},
                                      {{odd.n, odd.u, odd.v}, 1, {1000, -1000, 1000}},
                                      {{odd.u, odd.v, odd.n}, 1e-3},
                                      {{odd.v, odd.n, odd.u}, 1e3, {1000, 0, 0}}};
    std::vector<ProbePoint> points;
    for (const Pair& pair : border_points()) points.push_back(pair.on);
    const Solution s = direct_light(open_room());
    const std::vector<Light> here = RadiosityFunction(s).at(points);
    for (const Motion& motion : motions) {
        std::vector<ProbePoint> moved;
        for (const ProbePoint& p : points) moved.push_back({motion(p.x), motion.turned(p.n)});
        const Solution other = direct_light(open_room(motion));
        const std::vector<Light> there = RadiosityFunction(other).at(moved);
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_NEAR(there[i].irradiance[0] / here[i].irradiance[0], 1, 1e-9) << i;
            EXPECT_EQ(there[i].is_between_sides, here[i].is_between_sides) << i;
        }
    }
}

TEST(BorderLight, IsTheLimitForPathsToo) {
    const Scene scene = open_room();
    Progress progress;
    for (const auto& [on, beside] : border_points()) {
        // Both places use the same random numbers, which depend on the index in the list.
        const auto path = [&](const ProbePoint& p) {
            return reference_light(scene, std::array{p}, 1024, 1, progress, StopRequest())[0];
        };
        const ReferenceLight found = path(on), expected = path(beside);
        // Most of the 1,024 paths are the same at both places.
        EXPECT_NEAR(found.irradiance[0], expected.irradiance[0],
                    1e-3 * expected.irradiance[0] + expected.standard_error[0])
            << on.x.x << ' ' << on.x.y << ' ' << on.x.z;
        EXPECT_EQ(found.surface, expected.surface);
    }
}

TEST(BorderLight, IsMeasuredOnTheSideOfThePlanesMiddleInAllDirections) {
    const Solution s = direct_light(open_room());
    const RadiosityFunction light(s);
    Progress progress;
    // One row of points: the first is on the wall in x = 0, the fifth on the sheet.
    const auto grid_from = [&](double x, bool is_cylindrical) {
        Result<GridLight> grid = make_grid({{x, 0.3, 0.8}, {5, 0, 0}, {0, 0.4, 0}, 0.5});
        EXI_CHECK(static_cast<bool>(grid));
        grid->is_cylindrical = is_cylindrical;
        measure(light, *grid, progress, StopRequest());
        return *grid;
    };
    for (const bool is_cylindrical : {false, true}) {
        const GridLight on = grid_from(-0.25, is_cylindrical), beside = grid_from(-0.25 + step_inside, is_cylindrical);
        ASSERT_EQ(on.columns, 10);
        EXPECT_EQ(on.points[0].x, 0);
        EXPECT_NEAR(on.irradiance[0][0] / beside.irradiance[0][0], 1, 1e-3);
        EXPECT_TRUE(on.is_open[0]);
        EXPECT_EQ(on.points[4].x, 2);
        EXPECT_NEAR(on.irradiance[4][0] / beside.irradiance[4][0], 1, 1e-3);  // the middle is at x = 2.25
    }
}

TEST(BorderLight, IsMeasuredFromInsideForTheLevelsOfAFace) {
    // Half of the points are on edges of triangles, and therefore on walls. Light from outside does not reach those on
    // the floor.
    const Solution s = direct_light(open_room());
    const RadiosityFunction light(s);
    Progress progress;
    const std::vector<SurfacePoints> found =
        measure_surfaces(light, std::array{SurfaceId(0)}, 16, progress, StopRequest());
    double most = 0;
    for (const Light& there : found[0].light) most = std::max(most, there.irradiance[0]);
    double max_inside = 0;
    std::vector<ProbePoint> points;
    for (int i = 1; i < 40; ++i)
        for (int k = 1; k < 30; ++k) points.push_back({{0.1 * i + 1e-3, 0.1 * k, 0}, {0, 0, 1}});
    for (const Light& there : light.at(points)) max_inside = std::max(max_inside, there.irradiance[0]);
    EXPECT_LT(most, 1.01 * max_inside);
}

}  // namespace
}  // namespace exitance
