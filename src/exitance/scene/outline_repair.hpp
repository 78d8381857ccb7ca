#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/polygon.hpp"

namespace exitance {

/// Turns the holes of an outline that run the way of its rim: where an outline comes back to a corner, what it runs
/// around in between is a loop, and a loop within an odd number of others is a hole (even-odd, as Radiance has it).
/// Numbers of points. Returns how many were turned.
std::size_t turn_holes(std::span<const Point> points, const Normal& n, std::vector<std::uint32_t>& outline);

/// Leaves out corners that stand on the wrong side of another edge of the outline by at most `tolerance`, until no two
/// edges cross by more than `place` (metres). Returns whether that was possible; `dropped` counts them.
bool drop_crossing_corners(std::span<const Point> points, const Normal& n, double place, double tolerance,
                           std::vector<std::uint32_t>& outline, std::size_t& dropped);

/// Does an outline that comes back to a corner bound one polygon with holes? Not where lobes of opposite sense meet.
/// area       of the outline, m^2
/// tolerance  within which corners are in line, metres
bool is_one_polygon(std::span<const Point> points, std::span<const std::uint32_t> outline, const Vec3& area,
                    double tolerance);

}  // namespace exitance
