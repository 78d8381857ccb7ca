#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Returns all pairs of unit vectors within an angle (radians, at least 0.07): indices with the larger one first.
/// O(directions x directions within the angle).
std::vector<std::pair<std::uint32_t, std::uint32_t>> near_pairs(std::span<const Normal> directions, double angle);

}  // namespace exitance
