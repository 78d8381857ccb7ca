#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Sorts directions so that neighbours in the order are similar: by cells of an octahedral map, in Morton order. Ray
/// packets of similar directions visit the same parts of a scene.
class DirectionOrder {
  public:
    /// Returns the indices of the directions in this order; those of one cell keep theirs. Directions need not have
    /// length 1. The span is valid until the next call. O(directions).
    std::span<const std::uint32_t> sort(std::span<const Vec3> directions);

  private:
    std::vector<std::uint16_t> cell_;
    std::vector<std::uint32_t> first_, order_;
};

}  // namespace exitance
