#pragma once

#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// The plane n . x = offset; n points to its front side.
struct Plane {
    Normal n;
    double offset = 0;

    double signed_distance(const Point& p) const { return dot(n, p) - offset; }
};

/// Vector whose length is the area of a planar outline (m^2) and whose direction is its normal; the outline is
/// counter-clockwise seen from the front. Computed relative to the first corner, so that outlines far from the origin
/// lose no digits.
Vec3 area_vector(std::span<const Point> outline);

/// True if a planar outline with the given normal is convex. Collinear corners are allowed; a corner may be concave by
/// a triangle of area `tolerance`, m^2.
bool is_convex(std::span<const Point> outline, const Normal& n, double tolerance = 0);

/// True if the outline contains a point of its plane. Counts crossings after projection along the axis on which the
/// normal is largest; for points on the border either result is possible.
bool contains(std::span<const Point> outline, const Normal& n, const Point& p);

/// Centroid of the area of a planar outline.
Point centroid(std::span<const Point> outline);

/// Clips a polygon to the closed half-space signed_distance >= 0 (Sutherland and Hodgman). A concave polygon may get
/// edges that overlap in opposite directions along the plane; contour integrals over it stay correct.
/// Writes to `out`, which is cleared first; it is empty if fewer than three corners remain.
void clip(std::span<const Point> outline, const Plane& plane, std::vector<Point>& out);

}  // namespace exitance
