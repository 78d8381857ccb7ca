#pragma once

#include <span>
#include <vector>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

struct LeafNumbering;
class RayRows;

/// Assigns leaves between rooms, such as the sides of a door, to the brightest room that their rays reach, if it is far
/// brighter than their own. All leaves of a group are assigned to one room. Most rays of such leaves hit other leaves
/// between the rooms, so that the room found for them is a matter of chance. In a dim room they would have a large
/// share of all light, and would have to be as accurate as the rest of the room.
///
/// light    mean light of every room, W/m^2
/// room_of  room of every leaf, as found from the hits of rays
///
/// Returns the room of every leaf.
std::vector<std::size_t> given_to_brighter(const RayRows& rows, const ElementTree& tree, const LeafNumbering& numbering,
                                           std::span<const double> light, std::span<const std::size_t> room_of);

}  // namespace exitance
