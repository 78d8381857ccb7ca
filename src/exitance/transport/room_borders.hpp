#pragma once

#include <span>
#include <vector>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

struct LeafNumbering;
class RayRows;

/// Assigns leaves between rooms to the brightest one that they see if it is far brighter than their own, all leaves of
/// a group to one room. Most of their rays hit one another, so that they may have been put with either room. In a dim
/// room they would hold much of the light, and would have to be as accurate as the rest of it.
/// room_of   room of every leaf, as found from what the leaves see
/// light     mean light of every room, W/m^2
/// Returns the room of every leaf.
std::vector<std::size_t> given_to_brighter(const RayRows& rows, const ElementTree& tree, const LeafNumbering& numbering,
                                           std::span<const double> light, std::span<const std::size_t> room_of);

}  // namespace exitance
