#pragma once

#include <span>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Returns the form factor from a point to a polygon without occlusion: the share of diffuse emission around n at x
/// that reaches the polygon's front. It equals the irradiance at x divided by the exitance of the polygon.
///
///     F = 1/(2 pi) sum_i  g_i  n . (R_(i+1) x R_i),    g_i = angle(R_i, R_(i+1)) / |R_i x R_(i+1)|
///
/// over the edges of the part of `source` above the plane of x; R_i is the vector from x to corner i.
/// x       point, metres
/// n       its unit normal
/// source  simple planar polygon, metres, counter-clockwise seen from its front; need not be convex
/// Returns a number in [0, 1]; 0 if x is behind the source or in its plane (within 8 ulp of the coordinates). Relative
/// error 1e-12 at any distance and angle, unless x's distance to the source's plane or the source's height above the
/// horizon has fewer digits itself. O(corners). Source: [Baum89], after Lambert.
double point_to_polygon(const Point& x, const Normal& n, std::span<const Point> source);

/// Returns the same sum for corners relative to x. Does not check which way the source faces; the result is negative
/// for corners that run clockwise seen from x. The part below the horizon n . R = 0 is omitted.
double contour_sum(const Normal& n, std::span<const Vec3> corners);

/// Contour sum edge by edge, for contours given in pieces (all above the horizon n . R = 0). If the contour subtends a
/// small angle, the terms of the edges nearly cancel. Then, with the centre C and g_i = 1/C.C + u_i, the first parts
/// sum to twice the area vector over C.C, computed from short vectors, and the parts with u_i are as small as the
/// contour, so that no digits are lost.
class EdgeSum {
  public:
    /// All edges added later must be inside the pyramid over `corners` (relative to x), and in their plane if the
    /// contour is small.
    EdgeSum(const Normal& n, std::span<const Vec3> corners);
    bool is_small() const { return is_small_; }

    void add(const Vec3& a, const Vec3& b) { is_small_ ? add_to_small(a, b) : add_to_large(a, b); }
    /// Returns the form factor; negative for edges that run clockwise seen from x.
    double total() const { return (sum_ + (is_small_ ? twice_area_ / cc_ : 0)) / (-2 * pi); }

  private:
    void add_to_large(const Vec3& a, const Vec3& b);
    void add_to_small(const Vec3& a, const Vec3& b);

    Normal n_;
    Vec3 middle_;
    double cc_ = 0, twice_area_ = 0, sum_ = 0;
    bool is_small_ = false;
};

}  // namespace exitance
