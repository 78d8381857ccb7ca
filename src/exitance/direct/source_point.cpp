#include "exitance/direct/source_point.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {
namespace {

/// Ratio of the farthest to the nearest distance; the kernel changes by up to its fourth power. Chosen: half of it
/// and twice it change the rays by less than 1%, measured by `exitance solve carpet.obj --error 0.1` (carpet u=12
/// v=13 cuts=1 books=0).
constexpr double max_distance_ratio = 1.5;

/// Corners of a polygon whose triangles are sampled one by one. Those of other polygons are slivers from the first
/// corner: s chooses the direction from there, and t the distance, so that near numbers belong to near points. With the
/// 48 corners of the sun's disc, rays in its penumbra then have a third to a quarter of the variance.
constexpr std::size_t max_in_triangles = 4;

/// Squared distance of x to a convex polygon.
double nearest_squared(std::span<const Point> corners, const Normal& n, const Point& x) {
    const std::size_t m = corners.size();
    double nearest = HUGE_VAL;
    bool is_inside = true;
    for (std::size_t i = 0; i < m; ++i) {
        const Vec3 edge = corners[(i + 1) % m] - corners[i], from = x - corners[i];
        const double length = squared_norm(edge);
        is_inside = is_inside && dot(n, cross(edge, from)) >= 0;
        const double along = length > 0 ? std::clamp(dot(edge, from) / length, 0.0, 1.0) : 0;
        nearest = std::min(nearest, squared_norm(from - along * edge));
    }
    const double height = dot(n, x - corners[0]);
    return is_inside ? height * height : nearest;
}

/// Angle at a between the arcs to b and c; all are unit vectors.
double angle_at(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = cross(a, b), ac = cross(a, c);
    return std::atan2(norm(cross(ab, ac)), dot(ab, ac));
}

/// Unit vector perpendicular to b in the plane of a and b.
Vec3 turned_to(const Vec3& a, const Vec3& b) {
    return normalized(a - dot(a, b) * b);
}

}  // namespace

Point uniform_on(std::span<const Point> corners, double area_of_all, double s, double t) {
    double rest = s * 2 * area_of_all;
    for (std::size_t i = 2;; ++i) {
        const Vec3 a = corners[i - 1] - corners[0], b = corners[i] - corners[0];
        const double area = norm(cross(a, b));
        if (rest < area || i + 1 == corners.size()) {
            const Vec2 uv = uniform_in_shape(Patch::Shape::triangle, std::min(rest / area, 1.0), t);
            return corners[0] + uv.x * a + uv.y * b;
        }
        rest -= area;
    }
}

SeenPolygon::SeenPolygon(std::span<const Point> corners, const Normal& n, double area, const Point& x)
    : corners_(corners), n_(n), area_(area), x_(x) {
    double farthest = 0;
    for (const Point& p : corners) farthest = std::max(farthest, squared_norm(p - x));
    const double nearest = nearest_squared(corners, n, x);
    // Relative to the farthest: x is in the polygon, so that directions to it are undefined. The square of
    // coplanar_share; derived from rounding like that.
    constexpr double min_squared_ratio = 1e-12;
    if (farthest <= max_distance_ratio * max_distance_ratio * nearest || nearest <= min_squared_ratio * farthest) {
        for (std::size_t i = 2; i < corners.size(); ++i)
            area_before_.push_back(area_before_.back() +
                                   0.5 * norm(cross(corners[i - 1] - corners[0], corners[i] - corners[0])));
        return;
    }
    const Vec3 a = normalized(corners[0] - x);
    for (std::size_t i = 2; i < corners.size(); ++i) {
        const Vec3 b = normalized(corners[i - 1] - x), c = normalized(corners[i] - x);
        const double seen = 2 * std::atan2(std::abs(dot(a, cross(b, c))), 1 + dot(a, b) + dot(b, c) + dot(c, a));
        // sr; derived from double precision, in which angles of smaller triangles have relative errors above 1e-7
        constexpr double min_solid_angle = 1e-9;
        if (!(seen > min_solid_angle)) continue;
        const double angle = angle_at(a, b, c);
        triangles_.push_back({a, b, c, angle, std::sin(angle), std::cos(angle), seen});
        solid_angle_ += seen;
    }
}

Vec3 SeenPolygon::direction(double s, double t) const {
    double rest = s * solid_angle_;
    std::size_t k = 0;
    while (k + 1 < triangles_.size() && rest >= triangles_[k].solid_angle) rest -= triangles_[k++].solid_angle;
    const auto& [a, b, c, alpha, sin_alpha, cos_alpha, solid_angle] = triangles_[k];
    // Sub-triangle with this solid angle: bounded by the arc ab and the arc from b to a point on the arc ac.
    const double phi = std::clamp(rest, 0.0, solid_angle) - alpha;
    const double sine = std::sin(phi), cosine = std::cos(phi), u = cosine - cos_alpha;
    const double v = sine + sin_alpha * dot(a, b);
    const double down = (v * sine + u * cosine) * sin_alpha;
    const double q = down != 0 ? ((v * cosine - u * sine) * cos_alpha - v) / down : 1;
    const double along = std::clamp(q, dot(a, c), 1.0);
    const Vec3 end = along * a + std::sqrt(std::max(0.0, 1 - along * along)) * turned_to(c, a);
    const double z = 1 - t * (1 - dot(end, b));
    return z * b + std::sqrt(std::max(0.0, 1 - z * z)) * turned_to(end, b);
}

Point SeenPolygon::at(double s, double t) const {
    if (triangles_.empty()) return uniform_in_area(s, t);
    const Vec3 w = direction(s, t);
    return x_ + (dot(n_, corners_[0] - x_) / dot(n_, w)) * w;
}

/// Like uniform_on(), in the time of a search: the polygon of the sun's disc has 48 corners.
Point SeenPolygon::uniform_in_area(double s, double t) const {
    const double wanted = s * area_before_.back();
    const auto after = std::upper_bound(area_before_.begin() + 1, area_before_.end() - 1, wanted);
    // the chosen triangle has corners 0, k and k + 1
    const auto k = static_cast<std::size_t>(after - area_before_.begin());
    const double of_triangle = area_before_[k] - area_before_[k - 1];
    const double share = of_triangle > 0 ? std::min((wanted - area_before_[k - 1]) / of_triangle, 1.0) : 0;
    const Vec3 a = corners_[k] - corners_[0], b = corners_[k + 1] - corners_[0];
    if (corners_.size() > max_in_triangles) {
        const double away = std::sqrt(t);
        return corners_[0] + away * ((1 - share) * a + share * b);
    }
    const Vec2 uv = uniform_in_shape(Patch::Shape::triangle, share, t);
    return corners_[0] + uv.x * a + uv.y * b;
}

double SeenPolygon::weight(const Vec3& d, const Normal& receiver) const {
    const double above = dot(receiver, d), below = -dot(n_, d), squared = squared_norm(d);
    if (above <= 0 || below <= 0) return 0;
    return triangles_.empty() ? above * below / (squared * squared) : above / std::sqrt(squared);
}

}  // namespace exitance
