#include "exitance/samples/room_parts.hpp"

#include <cmath>

namespace exitance {

void add_around(PolygonKit& kit, const char* group, const char* material, const Point& p, const Vec3& a, const Vec3& b,
                double width, double height, const WallOpening& o, const Point& seen) {
    const auto part = [&](double u0, double v0, double u1, double v1) {
        if (u1 - u0 <= 0 || v1 - v0 <= 0) return;
        kit.facing(seen, group, material,
                   {p + u0 * a + v0 * b, p + u1 * a + v0 * b, p + u1 * a + v1 * b, p + u0 * a + v1 * b});
    };
    part(0, 0, o.u0, height);
    part(o.u1, 0, width, height);
    part(o.u0, 0, o.u1, o.v0);
    part(o.u0, o.v1, o.u1, height);
}

void add_room(PolygonKit& kit, const Point& lo, const Point& hi, const char* floor, const char* ceiling,
              const char* wall) {
    kit.horizontal("floor", floor, lo.x, lo.y, hi.x, hi.y, lo.z);
    kit.horizontal("ceiling", ceiling, lo.x, lo.y, hi.x, hi.y, hi.z, false);
    const std::array<Vec2, 4> corner = {Vec2{lo.x, lo.y}, {hi.x, lo.y}, {hi.x, hi.y}, {lo.x, hi.y}};
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2 p = corner[i], q = corner[(i + 1) % 4];
        kit.facing(0.5 * (lo + hi), "walls", wall,
                   {{p.x, p.y, lo.z}, {q.x, q.y, lo.z}, {q.x, q.y, hi.z}, {p.x, p.y, hi.z}});
    }
}

void add_materials(PolygonKit& kit, double radiance) {
    kit.material("floor", 0.4);
    kit.material("ceiling", 0.8);
    kit.material("wall", 0.7);
    kit.material("thing", PolygonKit::Colour{0.6, 0.5, 0.4});
    kit.material("light", 0, radiance);
}

void add_lamp(PolygonKit& kit, double x, double y, double z, double width, double length, double thickness) {
    const Point lo{x - width / 2, y - length / 2, z}, hi{x + width / 2, y + length / 2, z + thickness};
    kit.box("lamp", "ceiling", lo, hi, {false, true, ~0u});
    kit.horizontal("lamp", "light", lo.x, lo.y, hi.x, hi.y, z, false);
}

void add_sheet(PolygonKit& kit, const char* group, const char* material, const Point& a, const Point& b,
               const Point& c) {
    kit.polygon(group, material, {a, b, c});
    kit.polygon(group, material, {c, b, a});
}

Vec3 random_direction(MersenneTwister& random) {
    const double z = random.uniform(-1, 1), angle = random.uniform(0, 2 * pi), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

void add_beam(PolygonKit& kit, const char* group, const char* material, const Point& from, const Point& to,
              const Vec3& width, const Vec3& height) {
    const Vec3 along = to - from;
    const Point middle = 0.5 * (from + to);
    const auto face = [&](const Vec3& out, const Vec3& a, const Vec3& b) {
        const Point m = middle + 0.5 * out;
        const Vec3 i = 0.5 * a, j = 0.5 * b;
        kit.facing(m + out, group, material, {m - i - j, m + i - j, m + i + j, m - i + j});
    };
    for (const double side : {-1.0, 1.0})
        face(side * along, width, height), face(side * width, height, along), face(side * height, along, width);
}

void add_sun(PolygonKit& kit, const Point& target, double distance, double azimuth, double altitude,
             double irradiance) {
    // The sun's angular radius is 0.2665 degrees. The square has the solid angle of that disc.
    constexpr double radius = 0.2665 * pi / 180;
    const double side = std::sqrt(pi) * distance * std::tan(radius);
    const double a = azimuth * pi / 180, h = altitude * pi / 180;
    const Vec3 to_sun{std::sin(a) * std::cos(h), std::cos(a) * std::cos(h), std::sin(h)};
    const Vec3 right{std::cos(a), -std::sin(a), 0}, up = cross(right, to_sun);
    kit.material("sun", 0, irradiance / (pi * radius * radius));
    const Point middle = target + distance * to_sun;
    const Vec3 i = 0.5 * side * right, j = 0.5 * side * up;
    kit.facing(target, "sun", "sun", {middle - i - j, middle + i - j, middle + i + j, middle - i + j});
}

}  // namespace exitance
