#include "exitance/transport/form_factor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "exitance/core/check.hpp"
#include "exitance/geometry/polygon.hpp"

namespace exitance {
namespace {

/// (1 - atan(s)/s) with t = s^2 < 0.01, to the last digit: the angle's shortfall against its tangent.
double arc_shortfall(double t) {
    return t * (1.0 / 3 - t * (1.0 / 5 - t * (1.0 / 7 - t * (1.0 / 9 - t * (1.0 / 11 - t * (1.0 / 13 - t / 15))))));
}

/// The sum over edges as it stands in the header; accurate unless the polygon looks small.
class NearSum {
  public:
    explicit NearSum(const Normal& n) : n_(n) {}

    void add(const Vec3& a, const Vec3& b) {
        const Vec3 c = cross(a, b - a);
        const double squared = squared_norm(c), d = dot(a, b);
        if (squared == 0) return;  // the edge points at x
        sum_ += angle_over_sine(squared, d) * dot(c, n_);
    }
    double total() const { return sum_; }

  private:
    static double angle_over_sine(double squared, double d) {
        if (d > 0 && squared < 0.01 * d * d) return (1 - arc_shortfall(squared / (d * d))) / d;
        const double sine = std::sqrt(squared);
        return std::atan2(sine, d) / sine;
    }
    Normal n_;
    double sum_ = 0;
};

/// The same sum when the polygon looks small: its edges' terms nearly cancel there. With C the polygon's middle and
/// g_i = 1/C.C + u_i, the first parts sum to twice the polygon's area vector over C.C, which is formed from short
/// vectors, and what u_i keeps is as small as the polygon, with all its digits.
class FarSum {
  public:
    FarSum(const Normal& n, const Vec3& middle) : n_(n), c_(middle), cc_(dot(middle, middle)) {}

    void add(const Vec3& a, const Vec3& b) {
        const Vec3 ra = a - c_, rb = b - c_, e = b - a, c = cross(a, e);
        const double delta = dot(c_, ra + rb) + dot(ra, rb), d = cc_ + delta;
        const double u = -(delta / cc_ + arc_shortfall(squared_norm(c) / (d * d))) / d;
        twice_area_ += dot(cross(ra, e), n_);
        rest_ += u * dot(c, n_);
    }
    double total() const { return twice_area_ / cc_ + rest_; }

  private:
    Normal n_;
    Vec3 c_;
    double cc_, twice_area_ = 0, rest_ = 0;
};

/// Hands the edges of the part above the horizon to `sum`, those along the horizon included.
template <class Sum>
void add_edges(const Normal& n, std::span<const Vec3> corners, Sum& sum) {
    const auto crossing = [](const Vec3& a, double ha, const Vec3& b, double hb) {  // from below, so that it is unique
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

double contour_sum(const Normal& n, std::span<const Vec3> corners) {
    Vec3 middle;
    double highest = -HUGE_VAL;
    for (const Vec3& r : corners) middle += r, highest = std::max(highest, dot(n, r));
    if (highest <= 0) return 0;
    middle *= 1.0 / static_cast<double>(corners.size());
    double squared_radius = 0;
    for (const Vec3& r : corners) squared_radius = std::max(squared_radius, squared_norm(r - middle));
    if (squared_radius < 1e-3 * squared_norm(middle)) {
        FarSum sum(n, middle);
        add_edges(n, corners, sum);
        return sum.total() / (-2 * pi);
    }
    NearSum sum(n);
    add_edges(n, corners, sum);
    return sum.total() / (-2 * pi);
}

double point_to_polygon(const Point& x, const Normal& n, std::span<const Point> source) {
    if (source.size() < 3) return 0;
    constexpr std::size_t on_stack = 32;
    Vec3 few[on_stack];
    std::vector<Vec3> many(source.size() > on_stack ? source.size() : 0);
    const std::span<Vec3> corners(many.empty() ? few : many.data(), source.size());
    double scale = std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)});
    for (std::size_t i = 0; i < source.size(); ++i) {
        corners[i] = source[i] - x;
        scale = std::max({scale, std::abs(source[i].x), std::abs(source[i].y), std::abs(source[i].z)});
    }
    const Vec3 whole = area_vector(corners);
    const double in_front = -dot(whole, corners[0]);
    if (in_front <= 8 * std::numeric_limits<double>::epsilon() * scale * norm(whole)) return 0;
    const double f = contour_sum(n, corners);
    EXI_ASSERT(f < 1 + 1e-9);  // a source that turns the wrong way around
    return std::clamp(f, 0.0, 1.0);
}

}  // namespace exitance
