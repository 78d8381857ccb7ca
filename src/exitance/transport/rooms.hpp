#pragma once

#include <vector>

#include "exitance/transport/stage.hpp"

namespace exitance {

/// Groups of pieces that light joins.
struct Rooms {
    /// The number of each root's room, the largest first; small rooms beyond some dozens share the last number.
    std::vector<std::uint32_t> of_root;
    std::size_t rays = 0;
};

/// A few rays from every leaf of `tree`: each that meets the front of a piece joins the two. What is sealed is told
/// apart for certain; what is joined through a keyhole may be. O(leaves) rays.
Rooms find_rooms(const Stage& stage, const ElementTree& tree, std::uint64_t seed);

}  // namespace exitance
