#pragma once

#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// An axis-aligned rectangle.
struct AxisRectangle {
    Vec2 lo, hi;
};

/// Tiles a polygon whose edges are all parallel to the axes with rectangles. For up to 12 cells between distinct
/// coordinates per axis, finds the guillotine cuts of minimal total length by dynamic programming (O(k^5) for k
/// coordinates per axis). Larger polygons are first divided along a short cut.
/// loops      any order and direction; their union by parity is tiled
/// tolerance  coordinates nearer than this are equal; the result is empty if an edge is tilted by more
std::vector<AxisRectangle> tile_by_rectangles(std::span<const std::vector<Vec2>> loops, double tolerance);

}  // namespace exitance
