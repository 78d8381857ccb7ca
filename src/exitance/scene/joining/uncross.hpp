#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/polygon.hpp"

namespace exitance {

/// The area enclosed by a self-crossing outline, as simple polygons.
struct UncrossedOutline {
    std::vector<Point> crossings;  ///< Points where edges cross, metres.
    /// Outlines of the parts, counter-clockwise seen from the front. Numbers below the corner count are corners, the
    /// others crossings. Empty if the outline encloses no area, or has more than `max_cuts_per_corner` crossings per
    /// corner.
    std::vector<std::vector<std::uint32_t>> parts;
};

/// Splits an outline at its crossings. Every region with a winding number other than 0 is kept once: a bow tie becomes
/// two triangles, and an outline that encircles its area twice becomes one polygon. All parts get the same front: the
/// side from which more area is encircled counter-clockwise. If both sides are equal, it is that of the part next to
/// the outline's first edge.
/// n          a unit normal of the outline's plane; corners may be off the plane
/// tolerance  distance within which points are one point, metres
/// O(m^2) for m corners.
UncrossedOutline uncross(std::span<const Point> outline, const Normal& n, double tolerance);

/// A unit normal, of either sign, of the plane of an outline whose signed area may be zero: the normal of the largest
/// triangle formed by the first corner, the corner farthest from it, and a third one. Zero if all corners are
/// collinear.
Normal normal_of_corners(std::span<const Point> outline);

}  // namespace exitance
