#pragma once

#include <span>
#include <vector>

#include "exitance/io/scenes/honeybee/honeybee_model.hpp"

namespace exitance {

/// The part of a planar polygon that is outside of its holes and of the openings, as polygons with the orientation of
/// its boundary. Holes and openings may touch or overlap each other and the border, or protrude beyond it. Corners
/// keep their coordinates exactly. A polygon without holes and openings is returned as it is; others become triangles.
/// Empty if nothing is left. O(n^2) for n corners.
std::vector<std::vector<Point>> punched(const HoneybeeOutline& outline, std::span<const HoneybeeOutline> openings);

}  // namespace exitance
