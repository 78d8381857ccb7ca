#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// For every point, the index of the first point of the list within `tolerance` (metres) of it, or its own index.
/// Points that are not finite are never merged. Uses a hash grid, expected O(points).
std::vector<std::uint32_t> weld(std::span<const Point> points, double tolerance);

}  // namespace exitance
