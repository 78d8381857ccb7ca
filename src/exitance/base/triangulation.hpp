#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Cuts a simple planar outline into triangles by clipping ears, the best shaped first. Outlines that touch themselves
/// (holes joined to the border by a bridge) are welcome. Ears without area are left out. O(corners^2) as a rule.
/// Returns indices into `outline`, counter-clockwise seen from the front.
/// Source: [Eberly08].
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Point> outline, const Normal& n);

/// Cuts a simple planar outline into convex pieces: triangles joined across diagonals while they stay convex. At most
/// four times as many as necessary. A convex outline comes back whole. Source: [HertelMehlhorn83].
std::vector<std::vector<std::uint32_t>> convex_pieces(std::span<const Point> outline, const Normal& n);

}  // namespace exitance
