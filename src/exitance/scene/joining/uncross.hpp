#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/polygon.hpp"

namespace exitance {

/// The area that a self-crossing outline runs around, as simple polygons.
struct UncrossedOutline {
    std::vector<Point> crossings;  ///< Where edges cross, metres.
    /// Outlines of the parts, counter-clockwise seen from the front. Numbers below the corner count are corners, the
    /// others crossings. Empty if the outline runs around no area, or has more than `max_cuts_per_corner` crossings per
    /// corner.
    std::vector<std::vector<std::uint32_t>> parts;
};

/// Splits an outline at its crossings. Every part of the plane with a winding number other than 0 is kept once, so that
/// a bow tie becomes two triangles and an outline that runs twice around its area becomes one polygon. All parts look
/// to one side: to the side from which more area is encircled counter-clockwise; if both sides are equal, to the side
/// of the first part that the outline encircles.
/// n          a unit normal of the outline's plane; corners may lie off the plane
/// tolerance  within which points are one point, metres
/// O(m^2) for m corners.
UncrossedOutline uncross(std::span<const Point> outline, const Normal& n, double tolerance);

/// A unit normal, of either sign, of the plane of an outline whose area may cancel out: that of the largest triangle of
/// the first corner, the corner that is farthest from it, and a third one. Zero if all corners are in line.
Normal normal_of_corners(std::span<const Point> outline);

}  // namespace exitance
