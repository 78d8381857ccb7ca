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
/// Square of the length over the area above which a polygon is cut across its length before it is cut into triangles.
/// Derived from rectangles eight times as long as wide: halving the length of a sliver takes two bisections, so that
/// triangles would grow in number with the square of the length.
constexpr double long_shape = 8;

/// A triangle is accepted, too, if its error is less than this share of the error that the whole source may have.
constexpr double negligible = 1e-2;

using Triangle = std::array<Vec3, 3>;

/// Sums over points of a triangle: of the kernel, and of the kernel times p.
struct Sums {
    double kernel = 0, weighted = 0;
    double mean() const { return kernel > 0 ? weighted / kernel : 0; }
};

/// Clips a convex cone of unit vectors to the directions on the side of a plane to which `normal` points.
std::vector<Vec3> beside_plane(std::span<const Vec3> corners, const Vec3& normal) {
    std::vector<Vec3> out;
    for (std::size_t i = 0, m = corners.size(); i < m; ++i) {
        const Vec3 &p = corners[i], &q = corners[i + 1 == m ? 0 : i + 1];
        const double of_p = dot(normal, p), of_q = dot(normal, q);
        if (of_p >= 0) out.push_back(p);
        if ((of_p > 0 && of_q < 0) || (of_p < 0 && of_q > 0))
            out.push_back(normalized(p + (of_p / (of_p - of_q)) * (q - p)));
    }
    return out;
}

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

/// Integrates over the cone of directions in which a source is seen, which is cut into cones of triangles. Edges are
/// cut by their angles: of a source that is seen at a grazing angle, or that is near, most of the length hides little
/// light.
class DirectedIntegral {
  public:
    DirectedIntegral(const Normal& n, const RelativeRadiance& p)
        : n_(n), p_(p), widest_(std::max(p.smooth_width(), smooth_angle)) {}

    /// `corners`: of a convex polygon.
    double operator()(std::span<const Vec3> corners) {
        Cone cone(corners.begin(), corners.end());
        for (Vec3& r : cone) r = normalized(r);
        // Small sources keep their coordinates, which have more digits than differences of unit vectors.
        is_unit_ = squared_norm(longest_chord(cone).along) > widest_ * widest_;
        if (!is_unit_) cone.assign(corners.begin(), corners.end());
        Sums guess;
        const int depth = p_.breaks_at_horizon() ? max_bisections : 0;  // otherwise p is smooth: one point is enough
        for_triangles(cone, 0, [&](const Triangle& t) { add_coarse(t, depth, guess); });
        // Factor 0.5, since the estimate may be up to twice the mean.
        allowed_ = accepted_difference * std::max(min_mean, 0.5 * guess.mean());
        corners_ = corners, total_ = -1;
        double sum = 0;
        for_triangles(cone, 0, [&](const Triangle& t) { sum += part(t, 0); });
        return sum;
    }

  private:
    using Cone = std::vector<Vec3>;

    struct Chord {
        Vec3 along;       ///< Between the two directions that are farthest apart.
        double area = 0;  ///< Sum over the triangles between the first direction and the others.
    };
    static Chord longest_chord(const Cone& cone) {
        Chord out;
        for (std::size_t i = 1; i < cone.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k)
                if (const Vec3 d = cone[i] - cone[k]; squared_norm(d) > squared_norm(out.along)) out.along = d;
            if (i >= 2) out.area += 0.5 * norm(cross(cone[i - 1] - cone[0], cone[i] - cone[0]));
        }
        return out;
    }

    /// Calls use(triangle) for triangles that fill a convex cone. Long cones are cut across their length first, until
    /// their parts are compact or small.
    template <class Use>
    void for_triangles(const Cone& cone, int cuts, const Use& use) const {
        const Chord chord = longest_chord(cone);
        const double length = squared_norm(chord.along);
        if (cuts == max_bisections || length <= widest_ * widest_ * squared_norm(cone[0]) ||
            length <= long_shape * chord.area) {
            for (std::size_t i = 2; i < cone.size(); ++i) use({cone[0], cone[i - 1], cone[i]});
            return;
        }
        for (const double sign : {1.0, -1.0})
            if (const Cone half = beside_plane(cone, sign * chord.along); half.size() >= 3)
                for_triangles(half, cuts + 1, use);
    }

    /// Adds a point r of a triangle. `weight` times above / r^4 is proportional to its projected solid angle.
    void add(const Vec3& r, double weight, Sums& sums) const {
        const double r2 = squared_norm(r), above = dot(n_, r);
        if (!(above > 0 && dot(p_.normal(), r) < 0)) return;
        const double kernel = weight * above / (r2 * r2);
        sums.kernel += kernel;
        sums.weighted += kernel * p_(-r / std::sqrt(r2));
    }
    /// Adds three points with barycentric coordinates a, b, b each.
    void add_three(const Triangle& t, double a, double weight, Sums& sums) const {
        const double b = 0.5 * (1 - a);
        for (std::size_t i = 0; i < 3; ++i) add(a * t[i] + b * (t[(i + 1) % 3] + t[(i + 2) % 3]), weight, sums);
    }

    static bool looks_wider(const Triangle& t, double angle) {
        const double longest =
            std::max({squared_norm(t[1] - t[0]), squared_norm(t[2] - t[1]), squared_norm(t[0] - t[2])});
        return longest > angle * angle * squared_norm(t[0]);
    }
    /// Splits a triangle at the middle of its longest edge.
    std::array<Triangle, 2> bisected(const Triangle& t) const {
        std::size_t i = 0;
        double longest = -1;
        for (std::size_t k = 0; k < 3; ++k)
            if (const double length = squared_norm(t[(k + 1) % 3] - t[k]); length > longest) longest = length, i = k;
        const Vec3 &a = t[i], &b = t[(i + 1) % 3], &c = t[(i + 2) % 3], m = is_unit_ ? normalized(a + b) : (a + b) / 2;
        return {Triangle{a, m, c}, Triangle{m, b, c}};
    }

    /// Estimates the mean of p from the centroids of triangles that subtend a small angle.
    void add_coarse(const Triangle& t, int depth, Sums& sums) const {
        if (depth < max_bisections / 2 && looks_wider(t, estimate_angle)) {
            for (const Triangle& half : bisected(t)) add_coarse(half, depth + 1, sums);
            return;
        }
        add((t[0] + t[1] + t[2]) / 3, std::abs(dot(t[0], cross(t[1] - t[0], t[2] - t[0]))), sums);
    }

    double part(const Triangle& t, int depth) {
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
            const double difference = std::abs(six.mean() - three.mean());
            if (depth == max_bisections || difference <= std::max(allowed_, accepted_difference * six.mean()))
                return six.mean() * std::max(0.0, contour_sum(n_, t));
            if (const double F = std::max(0.0, contour_sum(n_, t)); difference * F <= negligible * allowed_ * total())
                return six.mean() * F;
        }
        double sum = 0;
        for (const Triangle& half : bisected(t)) sum += part(half, depth + 1);
        return sum;
    }

    /// Form factor to the whole source.
    double total() {
        if (total_ < 0) total_ = std::max(0.0, contour_sum(n_, corners_));
        return total_;
    }

    const Normal& n_;
    const RelativeRadiance& p_;
    double widest_;         ///< Largest allowed angle of a triangle's longest edge, radians.
    double allowed_ = 0;    ///< Allowed absolute error of the relative radiance p_.
    bool is_unit_ = false;  ///< True if corners of triangles are unit vectors.
    std::span<const Vec3> corners_;
    double total_ = -1;  ///< Form factor to all of the source; negative if not known yet.
};

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
