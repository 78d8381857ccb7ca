#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace exitance {

inline constexpr double pi = std::numbers::pi;
inline constexpr double degree = pi / 180;  ///< One degree in radians.

/// A vector or point in space; metres unless it is a direction.
struct Vec3 {
    double x = 0, y = 0, z = 0;

    constexpr double operator[](std::size_t axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    constexpr double& operator[](std::size_t axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    constexpr bool operator==(const Vec3&) const = default;
    constexpr Vec3& operator+=(const Vec3& o) { return x += o.x, y += o.y, z += o.z, *this; }
    constexpr Vec3& operator-=(const Vec3& o) { return x -= o.x, y -= o.y, z -= o.z, *this; }
    constexpr Vec3& operator*=(double s) { return x *= s, y *= s, z *= s, *this; }
};

using Point = Vec3;   ///< A position, metres.
using Normal = Vec3;  ///< A direction of length 1.

constexpr Vec3 operator+(Vec3 a, const Vec3& b) {
    return a += b;
}
constexpr Vec3 operator-(Vec3 a, const Vec3& b) {
    return a -= b;
}
constexpr Vec3 operator-(const Vec3& a) {
    return {-a.x, -a.y, -a.z};
}
constexpr Vec3 operator*(Vec3 a, double s) {
    return a *= s;
}
constexpr Vec3 operator*(double s, Vec3 a) {
    return a *= s;
}
constexpr Vec3 operator/(Vec3 a, double s) {
    return a *= 1 / s;
}
constexpr double dot(const Vec3& a, const Vec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
constexpr double squared_norm(const Vec3& a) {
    return dot(a, a);
}
inline double norm(const Vec3& a) {
    return std::sqrt(dot(a, a));
}
/// Returns the unit vector with third coordinate z, turned by `turn` times 2 pi about the third axis. With z uniform in
/// [-1, 1] and `turn` uniform in [0, 1), directions are uniform.
inline Vec3 direction_at(double z, double turn) {
    const double r = std::sqrt(std::max(0.0, 1 - z * z)), angle = 2 * pi * turn;
    return {r * std::cos(angle), r * std::sin(angle), z};
}
inline Vec3 normalized(const Vec3& a) {
    return a / norm(a);
}
inline bool is_finite(const Vec3& a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
constexpr Vec3 min(const Vec3& a, const Vec3& b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
constexpr Vec3 max(const Vec3& a, const Vec3& b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

/// A point or vector in the coordinates of a plane.
struct Vec2 {
    double x = 0, y = 0;
    constexpr bool operator==(const Vec2&) const = default;
};
constexpr Vec2 operator+(Vec2 a, Vec2 b) {
    return {a.x + b.x, a.y + b.y};
}
constexpr Vec2 operator-(Vec2 a, Vec2 b) {
    return {a.x - b.x, a.y - b.y};
}
constexpr Vec2 operator*(double s, Vec2 a) {
    return {s * a.x, s * a.y};
}
constexpr double dot(Vec2 a, Vec2 b) {
    return a.x * b.x + a.y * b.y;
}
inline double length(Vec2 v) {
    return std::hypot(v.x, v.y);
}
constexpr double cross(Vec2 a, Vec2 b) {
    return a.x * b.y - a.y * b.x;
}

/// Orthonormal right-handed frame with a given third axis: u x v = n. Source: [Duff17].
struct Frame {
    Normal u, v, n;

    explicit Frame(const Normal& normal) : n(normal) {
        const double sign = std::copysign(1.0, n.z);
        const double a = -1 / (sign + n.z), b = n.x * n.y * a;
        u = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
        v = {b, sign + n.y * n.y * a, -n.y};
    }
    Vec3 to_world(double x, double y, double z) const { return x * u + y * v + z * n; }
};

/// An axis-aligned box; empty until something is added.
struct Box {
    Point lo{HUGE_VAL, HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

    void add(const Point& p) { lo = min(lo, p), hi = max(hi, p); }
    void add(const Box& b) { lo = min(lo, b.lo), hi = max(hi, b.hi); }
    bool is_empty() const { return lo.x > hi.x; }
    Point centre() const { return 0.5 * (lo + hi); }
    Vec3 size() const { return hi - lo; }
    double diagonal() const { return is_empty() ? 0 : norm(size()); }
    double half_area() const {
        const Vec3 d = size();
        return is_empty() ? 0 : d.x * d.y + d.y * d.z + d.z * d.x;
    }
};

}  // namespace exitance
