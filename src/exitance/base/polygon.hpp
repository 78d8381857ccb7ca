#pragma once

#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// The plane n . x = offset; its front is where n points.
struct Plane {
    Normal n;
    double offset = 0;

    double signed_distance(const Point& p) const { return dot(n, p) - offset; }
};

/// The vector whose length is the area of a planar outline (m^2) and whose direction is its normal,
/// counter-clockwise seen from the front. Relative to the first corner, so that far-away outlines keep their digits.
Vec3 area_vector(std::span<const Point> outline);

/// Is a planar outline with the given normal convex, collinear corners allowed, within `tolerance` (m^2, the area of a
/// corner's triangle)?
bool is_convex(std::span<const Point> outline, const Normal& n, double tolerance = 0);

/// Does the outline hold a point of its plane? By counting crossings along the axis on which the normal is largest;
/// points on the border may go either way.
bool contains(std::span<const Point> outline, const Normal& n, const Point& p);

/// Centroid of the area of a planar outline.
Point centroid(std::span<const Point> outline);

/// The part of a polygon in the closed half-space signed_distance >= 0 (Sutherland and Hodgman). A concave polygon
/// may come out with edges that run to and fro along the plane: contour sums over it stay right.
/// Writes to `out`, which is cleared first; fewer than three corners mean: nothing is left.
void clip(std::span<const Point> outline, const Plane& plane, std::vector<Point>& out);

}  // namespace exitance
