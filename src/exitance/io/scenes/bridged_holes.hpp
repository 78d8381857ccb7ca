#pragma once

#include <vector>

#include "exitance/base/polygon.hpp"

namespace exitance {

/// Joins the rim of a planar polygon and its holes to one outline: each hole is connected by a bridge that is traversed
/// in both directions and crosses no edge. Rim counter-clockwise and holes clockwise seen from the front; metres.
/// Returns the outline without a hole for which there is no bridge (crossing outlines). O(corners^2) per hole.
std::vector<Point> bridge_holes(const std::vector<Point>& rim, const std::vector<std::vector<Point>>& holes);

}  // namespace exitance
