#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// For every point the first point of the list within `tolerance` (metres) of it; itself when there is none before it.
/// Points that are not finite stand for themselves. A hash grid, expected O(points).
std::vector<std::uint32_t> weld(std::span<const Point> points, double tolerance);

}  // namespace exitance
