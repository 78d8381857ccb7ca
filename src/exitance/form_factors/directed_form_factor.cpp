#include "exitance/form_factors/directed_form_factor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "exitance/form_factors/point_to_polygon.hpp"

namespace exitance {
namespace {

/// Allowed difference between the means of three and of six points, relative; the error of six is smaller.
constexpr double accepted_difference = 1e-3;
/// Share of this: if the means of one and of three points differ by less, three are enough.
constexpr double three_point_agreement = 0.3;
/// Values of p below this share are given an absolute tolerance, relative to this value.
constexpr double min_mean = 0.02;
constexpr double smooth_angle = 2 * pi / 180;  ///< Triangles that subtend less are treated as smooth, radians.
constexpr double estimate_angle = 0.3;         ///< Size of the triangles for the first estimate of the mean, radians.
constexpr int max_bisections = 20;             ///< Maximum number of bisections of a triangle.

using Triangle = std::array<Vec3, 3>;

/// Sums over points of a triangle: of the kernel, and of the kernel times p.
struct Sums {
    double kernel = 0, weighted = 0;
    double mean() const { return kernel > 0 ? weighted / kernel : 0; }
};

class DirectedIntegral {
  public:
    DirectedIntegral(const Normal& n, const RelativeRadiance& p)
        : n_(n), p_(p), widest_(std::max(p.smooth_width(), smooth_angle)) {}

    double operator()(std::span<const Vec3> corners) {
        Sums guess;
        const int depth = p_.breaks_at_horizon() ? max_bisections : 0;  // otherwise p is smooth: one point is enough
        for (std::size_t i = 2; i < corners.size(); ++i)
            add_coarse({corners[0], corners[i - 1], corners[i]}, depth, guess);
        // Factor 0.5, since the estimate may be up to twice the mean.
        allowed_ = accepted_difference * std::max(min_mean, 0.5 * guess.mean());
        double sum = 0;
        for (std::size_t i = 2; i < corners.size(); ++i) sum += part({corners[0], corners[i - 1], corners[i]}, 0);
        return sum;
    }

  private:
    /// Adds a point of the polygon; r is its position relative to the receiver point.
    void add(const Vec3& r, double weight, Sums& sums) const {
        const double r2 = squared_norm(r), above = dot(n_, r), before = -dot(p_.normal(), r);
        if (!(above > 0 && before > 0)) return;
        const double kernel = weight * above * before / (r2 * r2);
        sums.kernel += kernel;
        sums.weighted += kernel * p_(-r / std::sqrt(r2));
    }
    /// Adds three points with barycentric coordinates a, b, b each.
    void add_three(const Triangle& t, double a, double weight, Sums& sums) const {
        const double b = 0.5 * (1 - a);
        for (std::size_t i = 0; i < 3; ++i) add(a * t[i] + b * (t[(i + 1) % 3] + t[(i + 2) % 3]), weight, sums);
    }

    static bool looks_wider(const Triangle& t, double angle) {
        const Vec3 middle = (t[0] + t[1] + t[2]) / 3;
        const double longest =
            std::max({squared_norm(t[1] - t[0]), squared_norm(t[2] - t[1]), squared_norm(t[0] - t[2])});
        return longest > angle * angle * squared_norm(middle);
    }
    /// Splits a triangle at the middle of its longest edge.
    static std::array<Triangle, 2> bisected(const Triangle& t) {
        std::size_t i = 0;
        double longest = -1;
        for (std::size_t k = 0; k < 3; ++k)
            if (const double length = squared_norm(t[(k + 1) % 3] - t[k]); length > longest) longest = length, i = k;
        const Vec3 &a = t[i], &b = t[(i + 1) % 3], &c = t[(i + 2) % 3], m = (a + b) / 2;
        return {Triangle{a, m, c}, Triangle{m, b, c}};
    }

    /// Estimates the mean of p from the centroids of triangles that subtend a small angle.
    void add_coarse(const Triangle& t, int depth, Sums& sums) const {
        if (depth < max_bisections / 2 && looks_wider(t, estimate_angle)) {
            for (const Triangle& half : bisected(t)) add_coarse(half, depth + 1, sums);
            return;
        }
        add((t[0] + t[1] + t[2]) / 3, norm(cross(t[1] - t[0], t[2] - t[0])), sums);
    }

    double part(const Triangle& t, int depth) const {
        if (depth == max_bisections || !looks_wider(t, widest_)) {
            Sums one, three, six;
            add_three(t, 2.0 / 3, 1, three);
            if (p_.is_picture() && !looks_wider(t, p_.smooth_width()))
                return three.mean() * std::max(0.0, contour_sum(n_, t));
            if (!looks_wider(t, 0.5 * widest_)) {
                add((t[0] + t[1] + t[2]) / 3, 1, one);
                if (std::abs(three.mean() - one.mean()) <=
                    three_point_agreement * std::max(allowed_, accepted_difference * one.mean()))
                    return three.mean() * std::max(0.0, contour_sum(n_, t));
            }
            add_three(t, 0.108103018168070, 0.223381589678011, six);  // degree 4 [Dunavant85]
            add_three(t, 0.816847572980459, 0.109951743655322, six);
            if (depth == max_bisections ||
                std::abs(six.mean() - three.mean()) <= std::max(allowed_, accepted_difference * six.mean()))
                return six.mean() * std::max(0.0, contour_sum(n_, t));
        }
        double sum = 0;
        for (const Triangle& half : bisected(t)) sum += part(half, depth + 1);
        return sum;
    }

    const Normal& n_;
    const RelativeRadiance& p_;
    double widest_;       ///< Largest allowed angle of a triangle's longest edge, radians.
    double allowed_ = 0;  ///< Allowed absolute error of the relative radiance p_.
};

}  // namespace

namespace {

/// Clips the corners to the half-space above (sign 1) or below (sign -1) the horizon z = 0.
std::vector<Vec3> beside_horizon(std::span<const Vec3> corners, double sign) {
    std::vector<Vec3> out;
    for (std::size_t i = 0, m = corners.size(); i < m; ++i) {
        const Vec3 &p = corners[i], &q = corners[i + 1 == m ? 0 : i + 1];
        if (sign * p.z >= 0) out.push_back(p);
        if ((p.z > 0 && q.z < 0) || (p.z < 0 && q.z > 0)) {
            out.push_back(p + (p.z / (p.z - q.z)) * (q - p));
            out.back().z = 0;
        }
    }
    return out;
}

}  // namespace

double directed_form_factor(const Normal& n, std::span<const Vec3> corners, const RelativeRadiance& p) {
    const auto is_below = [](const Vec3& r) { return r.z < 0; };
    const auto is_above = [](const Vec3& r) { return r.z > 0; };
    if (p.breaks_at_horizon() && std::any_of(corners.begin(), corners.end(), is_below) &&
        std::any_of(corners.begin(), corners.end(), is_above)) {
        double sum = 0;
        for (const double sign : {1.0, -1.0})
            if (const std::vector<Vec3> part = beside_horizon(corners, sign); part.size() >= 3)
                sum += DirectedIntegral(n, p)(part);
        return sum;
    }
    return DirectedIntegral(n, p)(corners);
}

}  // namespace exitance
