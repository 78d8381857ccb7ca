#pragma once

#include <utility>
#include <vector>

#include "exitance/visibility/occluders.hpp"

namespace exitance {

/// Lines on a region at which faces nearly in its plane, turned against it by a tiny angle, begin or cease to cover it
/// (Occluders::is_covered): where they stand off it by their thickness, and where one on top goes under. Light jumps
/// there, far from every edge. O(pieces near the region), each with at most three lines, metres.
std::vector<std::pair<Point, Point>> cover_ends(const Occluders& occluders, RegionId region);

}  // namespace exitance
