#include "exitance/direct/direct_light.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/transport/stage.hpp"
#include "support/test_scenes.hpp"

namespace exitance {

TEST(DirectLight, ASheetDoesNotShadeItself) {
    // A slanted two-sided sheet under a lamp; its corners are rounded to twelve digits and thus not exactly in a plane.
    const std::vector<Point> sheet = {{0.331234567891, -1.2, 0.123456789012},
                                      {5.123456789013, -0.7, 1.234567890123},
                                      {4.9, 3.1, 1.987654321098},
                                      {0.1, 2.6, 0.876543210987}};
    std::vector<Point> front = sheet, back(sheet.rbegin(), sheet.rend());
    front[3] += Vec3{0, 0,
                     dot(area_vector(std::vector<Point>{sheet[0], sheet[1], sheet[2]}), sheet[0] - sheet[3]) /
                         area_vector(std::vector<Point>{sheet[0], sheet[1], sheet[2]}).z};
    front[3].z = std::round(front[3].z * 1e11) * 1e-11;
    back[0] = front[3];
    const Scene scene = test::make({{front}, {back}, {{{2, 0, 4}, {2, 1, 4}, {3, 1, 4}, {3, 0, 4}}, 10}});
    const Stage stage(scene);
    const RegionId own = scene.surfaces()[SurfaceId(0)].region;
    const Normal n = scene.surfaces()[SurfaceId(0)].normal;
    DirectLight::Workspace workspace;
    for (int i = 1; i < 20; ++i) {
        const Point x = front[0] + (0.04 * i) * (front[1] - front[0]) + 0.3 * (front[3] - front[0]);
        for (const double off : {-1e-9, 0.0, 1e-9})
            EXPECT_GT(stage.direct.irradiance(x + off * n, n, own, workspace)[0], 0) << i << ' ' << off;
    }
}

namespace {

/// A square and its back, turned about two axes and moved, with coordinates rounded to `digits` after the point. Sides
/// of 1 m.
std::vector<Point> turned_square(double a, double b, double digits) {
    const Vec3 u{std::cos(a), std::sin(a), 0}, n{-std::sin(a) * std::sin(b), std::cos(a) * std::sin(b), std::cos(b)};
    const Vec3 v = cross(n, u);
    std::vector<Point> out;
    for (const Vec2 c : {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}}) {
        const Point p = Point{0.3, -2.1, 1.7} + c.x * u + c.y * v;
        const auto rounded = [&](double x) { return std::round(x * digits) / digits; };
        out.push_back({rounded(p.x), rounded(p.y), rounded(p.z)});
    }
    return out;
}

}  // namespace

TEST(DirectLight, TheBackOfALampGetsNoneOfItsLight) {
    // In files, the corners of a lamp and of its back are rounded, so that either may be before the other.
    for (const double digits : {1e7, 1e9, 1e12, 1e16})
        for (int k = 0; k < 16; ++k) {
            const std::vector<Point> front = turned_square(0.37 * k, 0.1 + 0.17 * k, digits);
            std::vector<Point> back(front.rbegin(), front.rend());
            std::rotate(back.begin(), back.begin() + k % 4, back.end());
            const Point aside = front[0] + Vec3{0.3, 0.2, 3};
            const Scene scene = test::make(
                {{front, 10}, {back}, {{aside, aside + Vec3{1, 0, 0}, aside + Vec3{1, 1, 0}, aside + Vec3{0, 1, 0}}}});
            const Stage stage(scene);
            const Surface& of_back = scene.surfaces()[SurfaceId(1)];
            DirectLight::Workspace workspace;
            ReceiverLight light;
            stage.direct.prepare(back, of_back.normal, of_back.region, light, workspace);
            for (int i = 1; i < 10; ++i) {
                const Point x = back[0] + (0.09 * i) * (back[1] - back[0]) + 0.4 * (back[3] - back[0]);
                EXPECT_EQ(stage.direct.irradiance(light, x, workspace)[0], 0) << digits << ' ' << k << ' ' << i;
                EXPECT_EQ(stage.direct.irradiance(x, of_back.normal, of_back.region, workspace)[0], 0);
                const RayLight& rays = stage.place_light.rays();
                PlaceLight::Workspace room;
                EXPECT_LT(rays.at(x, of_back.normal, of_back.region, {.relative = 0.1}, room).irradiance[0], 1e-9);
            }
        }
}

}  // namespace exitance
