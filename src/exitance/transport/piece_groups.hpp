#pragma once

#include <vector>

#include "exitance/transport/stage.hpp"

namespace exitance {

/// Groups of pieces that exchange light, such as those of one sealed room. Clusters do not join pieces of two groups.
/// Unlike the rooms by which errors are judged (`LightRooms`), rooms that an opening connects are one group.
struct PieceGroups {
    /// Number of each root's group, in descending order of area. Groups from number 63 on share that number.
    std::vector<std::uint32_t> of_root;
    std::size_t rays = 0;
};

/// Casts a few rays from every leaf of `tree`; each that hits the front of a piece joins the two pieces. Sealed rooms
/// are always separated; rooms connected by a tiny opening may be separated too. O(leaves) rays.
PieceGroups find_piece_groups(const Stage& stage, const ElementTree& tree, std::uint64_t seed);

}  // namespace exitance
