#pragma once

#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// A rectangle along the axes.
struct AxisRectangle {
    Vec2 lo, hi;
};

/// Tiles a polygon whose edges are all parallel to the axes by rectangles.
/// Up to 12 cells between different coordinates an axis: the guillotine cuts of least total length, by dynamic
/// programming (O(k^5) for k coordinates an axis). Larger ones are cut in two first, where the cut is short.
/// loops      any order and direction; their union by parity is tiled
/// tolerance  coordinates nearer than this are one; an edge that is tilted by more makes the result empty
std::vector<AxisRectangle> tile_by_rectangles(std::span<const std::vector<Vec2>> loops, double tolerance);

}  // namespace exitance
