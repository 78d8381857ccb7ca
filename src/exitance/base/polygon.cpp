#include "exitance/base/polygon.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

/// Share of an outline's largest coordinate below which a corner's distance from a plane may be due to rounding.
/// Derived from the rounding of a coordinate, 1.1e-16: a remaining edge is at least 500 roundings of its ends long, so
/// that its direction is accurate to about 1e-2.
constexpr double in_plane = 1e-13;

}  // namespace

Vec3 area_vector(std::span<const Point> outline) {
    Vec3 sum;
    for (std::size_t i = 2; i < outline.size(); ++i) sum += cross(outline[i - 1] - outline[0], outline[i] - outline[0]);
    return 0.5 * sum;
}

bool is_convex(std::span<const Point> outline, const Normal& n, double tolerance) {
    const std::size_t m = outline.size();
    double turned = 0;  // a convex outline turns by 2 pi; a star turns more often
    for (std::size_t i = 0; i < m; ++i) {
        const Vec3 a = outline[(i + 1) % m] - outline[i], b = outline[(i + 2) % m] - outline[(i + 1) % m];
        const double turn = dot(n, cross(a, b));
        if (turn < -2 * tolerance) return false;
        turned += std::atan2(turn, dot(a, b));
    }
    return turned < 3 * pi;
}

bool contains(std::span<const Point> outline, const Normal& n, const Point& p) {
    const Vec3 size = {std::abs(n.x), std::abs(n.y), std::abs(n.z)};
    const std::size_t drop = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t s = (drop + 1) % 3, t = (drop + 2) % 3;
    bool inside = false;
    for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
        const Point &a = outline[i], &b = outline[j];
        if ((a[t] > p[t]) != (b[t] > p[t]) && p[s] - a[s] < (b[s] - a[s]) * ((p[t] - a[t]) / (b[t] - a[t])))
            inside = !inside;
    }
    return inside;
}

Point centroid(std::span<const Point> outline) {
    const Vec3 whole = area_vector(outline);
    const double squared_area = squared_norm(whole);
    Vec3 moment;
    for (std::size_t i = 2; i < outline.size(); ++i) {
        const Vec3 a = outline[i - 1] - outline[0], b = outline[i] - outline[0];
        moment += (0.5 * dot(cross(a, b), whole) / 3) * (a + b);
    }
    return squared_area > 0 ? outline[0] + moment / squared_area : outline[0];
}

void clip(std::span<const Point> outline, const Plane& plane, std::vector<Point>& out) {
    out.clear();
    const std::size_t m = outline.size();
    double largest = 0;
    for (const Point& p : outline) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    // A corner that is in the plane except for rounding stays one corner. Two new ones in its place would be the ends
    // of an edge with an arbitrary direction.
    const auto height = [&](const Point& p) {
        const double h = plane.signed_distance(p);
        return std::abs(h) <= in_plane * largest ? 0 : h;
    };
    for (std::size_t i = 0; i < m; ++i) {
        const Point &p = outline[i], &q = outline[(i + 1) % m];
        const double hp = height(p), hq = height(q);
        if (hp >= 0) out.push_back(p);
        // Interpolate from the lower to the higher corner, so that two faces that share an edge get the same point.
        if ((hp > 0 && hq < 0) || (hp < 0 && hq > 0)) {
            const bool forward = hp < hq;
            const Point &a = forward ? p : q, &b = forward ? q : p;
            const double ha = forward ? hp : hq, hb = forward ? hq : hp;
            out.push_back(a + (ha / (ha - hb)) * (b - a));
        }
    }
    if (out.size() < 3) out.clear();
}

}  // namespace exitance
