#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/polygon.hpp"

namespace exitance {

/// Reverses the holes of an outline that have the orientation of its rim. Where an outline returns to a corner, the
/// part in between is a loop; a loop inside an odd number of others is a hole (even-odd rule, as in Radiance).
/// `outline` has indices into `points`. Returns the number of reversed holes.
std::size_t turn_holes(std::span<const Point> points, const Normal& n, std::vector<std::uint32_t>& outline);

/// Removes corners that are on the wrong side of another edge of the outline by at most `tolerance`, until no two edges
/// cross by more than `place` (metres). Returns true if that was possible; `dropped` counts the removed corners.
bool drop_crossing_corners(std::span<const Point> points, const Normal& n, double place, double tolerance,
                           std::vector<std::uint32_t>& outline, std::size_t& dropped);

/// True if an outline that returns to a corner bounds one polygon with holes. False if parts with opposite orientation
/// meet there.
/// area       area vector of the outline, m^2
/// tolerance  for collinear corners, metres
bool is_one_polygon(std::span<const Point> points, std::span<const std::uint32_t> outline, const Vec3& area,
                    double tolerance);

}  // namespace exitance
