#pragma once

#include <cstdint>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/transport/light_openings.hpp"

namespace exitance {

/// An element is outdoors if at least this share of its rays reaches the sky. Derived from facades: under an open sky,
/// half of their rays reach it, and most of those of a ground.
constexpr double outdoors = 0.25;

/// Coarse elements of a scene, and the rays that they exchange light by.
struct CoarseElements {
    const Stage& stage;
    const ElementTree& tree;
    const LeafNumbering& numbering;
    const RayRows& rows;
    std::vector<std::uint32_t> escaped;  ///< Rays of each leaf that hit nothing (`RayRows::escaped`).
};

struct RoomLeaves {
    std::vector<LeafNumbers> rooms;  ///< The leaves of every room, in descending order of area.
    double spaces = 1;               ///< See `LightRooms::spaces`.
};

/// Divides the leaves of coarse elements into the rooms of a scene (`LightRooms`): cuts the scene at openings
/// (`find_opening`) until no part can be cut into rooms, merges parts that are too small with a neighbour, and assigns
/// leaves that see no front. Each leaf belongs to one room. Collective.
RoomLeaves find_room_leaves(const CoarseElements& in, std::uint64_t seed, const StopRequest& stop);

}  // namespace exitance
