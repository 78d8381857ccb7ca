#pragma once

#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Approximate round surfaces by planar polygons with 32 sides, counter-clockwise seen from outside (for a ring: from
/// the side of its normal). Radii are enlarged so that the area is exact for rings, spheres and cylinders and within
/// 0.5% for cones of any slope. No point deviates by more than 0.5% of the radius.
inline constexpr int sides_of_round = 32;

using Facets = std::vector<std::vector<Point>>;

/// Ring between two radii around an axis of length 1; the inner radius may be 0.
Facets ring_facets(const Point& centre, const Normal& normal, double inner, double outer);
/// Lateral surface between two discs; either radius may be 0.
Facets cone_facets(const Point& from, const Point& to, double radius_from, double radius_to);
Facets sphere_facets(const Point& centre, double radius);

}  // namespace exitance
