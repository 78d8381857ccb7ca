#pragma once

#include <span>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Form factor from a point to a polygon, nothing in between: the share of a diffuse emission around n at x that meets
/// the polygon's front; equally, the irradiance at x over the exitance of the polygon.
///
///     F = 1/(2 pi) sum_i  g_i  n . (R_(i+1) x R_i),    g_i = angle(R_i, R_(i+1)) / |R_i x R_(i+1)|
///
/// over the edges of the part of `source` above the plane of x; R_i leads from x to corner i.
/// Source: [Baum89], after Lambert. Exact but for rounding: 1e-12 relative, far, near and grazing, as long as x's own
/// distance to the source's plane and the source's height above the horizon have as many digits. O(corners).
/// x       point, metres           n        its unit normal
/// source  simple planar polygon, metres, counter-clockwise seen from its front; need not be convex
/// returns a number in [0, 1]; 0 when x lies behind the source or in its plane (within 8 ulp of the coordinates)
double point_to_polygon(const Point& x, const Normal& n, std::span<const Point> source);

/// The same sum for corners given relative to x, without a look at the source's facing, and signed: negative for
/// corners that run clockwise as seen from x. The part below the horizon n . R = 0 does not count.
double contour_sum(const Normal& n, std::span<const Vec3> corners);

/// The sum itself, edge by edge, for contours that come in pieces (all above the horizon n . R = 0). Where all of them
/// look small, as seen from x, the edges' terms nearly cancel: with C the middle and g_i = 1/C.C + u_i, the first parts
/// sum to twice the area vector over C.C, which is formed from short vectors, and what u_i keeps is as small as the
/// contour, with all its digits.
class EdgeSum {
  public:
    /// Every edge added later lies within the pyramid over `corners` (relative to x), and in their plane if they are
    /// small.
    EdgeSum(const Normal& n, std::span<const Vec3> corners);
    bool is_small() const { return is_small_; }

    void add(const Vec3& a, const Vec3& b) { is_small_ ? add_to_small(a, b) : add_to_large(a, b); }
    /// The form factor; negative for edges that run clockwise as seen from x.
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
