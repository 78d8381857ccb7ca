#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Triangulates a simple planar outline by clipping ears, the best shaped first. Outlines that touch themselves are
/// supported (holes joined to the border by a bridge). Ears without area are omitted. Usually O(corners^2).
/// Returns indices into `outline`, counter-clockwise seen from the front.
/// Source: [Eberly08].
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Point> outline, const Normal& n);

/// Splits a simple planar outline into convex pieces: adjacent triangles are merged while the union stays convex. At
/// most four times as many pieces as necessary; a convex outline is returned whole. Returns indices into `outline`.
/// Source: [HertelMehlhorn83].
std::vector<std::vector<std::uint32_t>> convex_pieces(std::span<const Point> outline, const Normal& n);

}  // namespace exitance
