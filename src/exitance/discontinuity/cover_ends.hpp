#pragma once

#include <utility>
#include <vector>

#include "exitance/visibility/occluders.hpp"

namespace exitance {

/// Lines on a region where the cover of a nearly coplanar face, tilted by a tiny angle, begins or ends
/// (Occluders::is_covered): where the face is its thickness away from the region, and where a face that lies on the
/// region dips below it. Light jumps at these lines, although no edge is near. Returns their end points, metres.
/// O(pieces near the region), at most three lines per piece.
std::vector<std::pair<Point, Point>> cover_ends(const Occluders& occluders, RegionId region);

}  // namespace exitance
