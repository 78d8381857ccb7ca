#pragma once

#include <span>
#include <vector>

#include "exitance/base/polygon.hpp"

namespace exitance {

/// Convex polygons of one plane, counter-clockwise seen from its front, metres.
using ConvexParts = std::vector<std::vector<Point>>;

/// Adds a convex polygon, divided into parts with at most 12 corners.
void add_parts(std::span<const Point> polygon, ConvexParts& parts);

/// True if a convex polygon is so narrow that rounding of its corners may have made it.
/// slack  points nearer to a line than this are on it, metres
bool is_negligible(std::span<const Point> polygon, double slack);

/// Intersection of two convex polygons with the normal n; fewer than three corners if there is none.
std::vector<Point> intersection(std::span<const Point> a, std::span<const Point> b, const Normal& n);

/// Adds the parts of a convex polygon that are outside a number of convex holes, which may overlap. About
/// O(h log h) time and O(h) parts for h holes.
/// n  normal of the polygon and of the holes
/// slack  see is_negligible(), metres
void subtract(std::span<const Point> polygon, std::span<const std::span<const Point>> holes, const Normal& n,
              double slack, ConvexParts& parts);

}  // namespace exitance
