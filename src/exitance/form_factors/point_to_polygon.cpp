#include "exitance/form_factors/point_to_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "exitance/base/check.hpp"
#include "exitance/base/polygon.hpp"

namespace exitance {
namespace {

/// Returns 1 - atan(s)/s for t = s^2 < 0.01, to the last digit: the relative difference between an angle and its
/// tangent.
double arc_shortfall(double t) {
    return t * (1.0 / 3 - t * (1.0 / 5 - t * (1.0 / 7 - t * (1.0 / 9 - t * (1.0 / 11 - t * (1.0 / 13 - t / 15))))));
}

double angle_over_sine(double squared_sine, double cosine) {
    if (cosine > 0 && squared_sine < 0.01 * cosine * cosine)
        return (1 - arc_shortfall(squared_sine / (cosine * cosine))) / cosine;
    const double sine = std::sqrt(squared_sine);
    return std::atan2(sine, cosine) / sine;
}

/// Adds the edges of the part above the horizon to `sum`, including the edges along the horizon.
void add_edges(const Normal& n, std::span<const Vec3> corners, EdgeSum& sum) {
    // Always from the lower end, so that the point is the same for both directions.
    const auto crossing = [](const Vec3& a, double ha, const Vec3& b, double hb) {
        const bool forward = ha < hb;
        return forward ? a + (ha / (ha - hb)) * (b - a) : b + (hb / (hb - ha)) * (a - b);
    };
    Vec3 first_entry, last_exit, a = corners.back();
    bool entered_first = false, outside = false;
    double ha = dot(n, a);
    for (const Vec3& b : corners) {
        const double hb = dot(n, b);
        if (ha >= 0 && hb >= 0) {
            sum.add(a, b);
        } else if (ha >= 0) {
            last_exit = crossing(a, ha, b, hb), outside = true;
            sum.add(a, last_exit);
        } else if (hb >= 0) {
            const Vec3 entry = crossing(a, ha, b, hb);
            if (outside) sum.add(last_exit, entry);
            if (!outside) first_entry = entry, entered_first = true;
            outside = false;
            sum.add(entry, b);
        }
        a = b, ha = hb;
    }
    if (outside && entered_first) sum.add(last_exit, first_entry);
}

}  // namespace

EdgeSum::EdgeSum(const Normal& n, std::span<const Vec3> corners) : n_(n) {
    for (const Vec3& r : corners) middle_ += r;
    middle_ *= 1.0 / static_cast<double>(corners.size());
    cc_ = squared_norm(middle_);
    double squared_radius = 0;
    for (const Vec3& r : corners) squared_radius = std::max(squared_radius, squared_norm(r - middle_));
    is_small_ = squared_radius < 1e-3 * cc_;
}

void EdgeSum::add_to_large(const Vec3& a, const Vec3& b) {
    const Vec3 c = cross(a, b - a);
    const double squared = squared_norm(c);
    if (squared > 0) sum_ += angle_over_sine(squared, dot(a, b)) * dot(c, n_);  // skip an edge that points at x
}

void EdgeSum::add_to_small(const Vec3& a, const Vec3& b) {
    const Vec3 ra = a - middle_, rb = b - middle_, e = b - a, c = cross(a, e);
    const double delta = dot(middle_, ra + rb) + dot(ra, rb), d = cc_ + delta;
    const double u = -(delta / cc_ + arc_shortfall(squared_norm(c) / (d * d))) / d;
    twice_area_ += dot(cross(ra, e), n_);
    sum_ += u * dot(c, n_);
}

double contour_sum(const Normal& n, std::span<const Vec3> corners) {
    double highest = -HUGE_VAL;
    for (const Vec3& r : corners) highest = std::max(highest, dot(n, r));
    if (highest <= 0) return 0;
    EdgeSum sum(n, corners);
    add_edges(n, corners, sum);
    return sum.total();
}

double point_to_polygon(const Point& x, const Normal& n, std::span<const Point> source) {
    if (source.size() < 3) return 0;
    constexpr std::size_t on_stack = 32;
    Vec3 stack_corners[on_stack];
    std::vector<Vec3> heap_corners(source.size() > on_stack ? source.size() : 0);
    const std::span<Vec3> corners(heap_corners.empty() ? stack_corners : heap_corners.data(), source.size());
    double scale = std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)});
    for (std::size_t i = 0; i < source.size(); ++i) {
        corners[i] = source[i] - x;
        scale = std::max({scale, std::abs(source[i].x), std::abs(source[i].y), std::abs(source[i].z)});
    }
    const Vec3 whole = area_vector(corners);
    const double in_front = -dot(whole, corners[0]);
    if (in_front <= 8 * std::numeric_limits<double>::epsilon() * scale * norm(whole)) return 0;
    const double f = contour_sum(n, corners);
    EXI_ASSERT(f < 1 + 1e-9);  // fails if the source is oriented the wrong way
    return std::clamp(f, 0.0, 1.0);
}

}  // namespace exitance
