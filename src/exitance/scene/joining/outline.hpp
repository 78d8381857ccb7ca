#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/polygon.hpp"

namespace exitance {

/// Removes corners equal to their predecessor, and spikes (a corner between two equal ones). `outline`: numbers of
/// points.
/// Returns the number of removed corners.
std::size_t drop_repeated_corners(std::vector<std::uint32_t>& outline);

/// True if all corners are within `tolerance` (metres) of one line.
bool is_collinear(std::span<const Point> outline, double tolerance);

/// The largest distance of a corner from the plane through the corners' mean, metres.
double out_of_plane(std::span<const Point> outline, const Normal& n);

/// Two edges, by the number of their first corner.
struct EdgePair {
    std::size_t first, second;
};

/// Finds two edges of a planar outline that cross by more than `tolerance` (metres). Edges may touch, and may coincide
/// in opposite directions (bridges to holes). Returns false if there are none.
/// O(m log m) if few edges overlap along x, O(m^2) at worst; O(m) for convex outlines.
bool crosses_itself(std::span<const Point> outline, const Normal& n, double tolerance, EdgePair& where);

}  // namespace exitance
