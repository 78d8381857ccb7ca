#pragma once

#include <array>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Round surfaces as planar polygons, 32 around: counter-clockwise seen from outside (of a ring: from where its normal
/// points). Radii are larger by what makes the area right: exactly for rings, spheres and cylinders, within 0.5% for
/// cones of any slope; no point is farther than 0.5% of the radius from where it should be.
inline constexpr int sides_of_round = 32;

using Facets = std::vector<std::vector<Point>>;

/// Between two radii about an axis of length 1, the inner one perhaps 0.
Facets ring_facets(const Point& centre, const Normal& normal, double inner, double outer);
/// The mantle between two discs, either radius perhaps 0.
Facets cone_facets(const Point& from, const Point& to, double radius_from, double radius_to);
Facets sphere_facets(const Point& centre, double radius);

}  // namespace exitance
