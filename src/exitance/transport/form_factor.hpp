#pragma once

#include <span>

#include "exitance/geometry/vec.hpp"

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
/// corners that run counter-clockwise as seen from x. The part below the horizon n . R = 0 does not count.
double contour_sum(const Normal& n, std::span<const Vec3> corners);

}  // namespace exitance
