#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/geometry/vec.hpp"

namespace exitance {

/// The constrained Delaunay triangulation of a polygon with holes: triangles of corners that hold every border edge and
/// have, of all such, the largest smallest angle. Exact predicates. Source: [CGAL].
/// loops    outer loops and holes in any order and direction; they may touch but not cross
/// returns  corners of triangles as numbers into the loops put end to end, counter-clockwise; where several corners
///          stand at one place, the first of them. Empty when the loops enclose nothing. O(n log n).
std::vector<std::array<std::uint32_t, 3>> delaunay_triangles(std::span<const std::vector<Vec2>> loops);

}  // namespace exitance
