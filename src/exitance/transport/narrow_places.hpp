#pragma once

#include "exitance/transport/stage.hpp"

namespace exitance {

/// The leaves that are large beside the gap over them: somewhere on the leaf something stands in front of it, nearer
/// than the leaf is wide. Light turns there within the height of the gap, which a polynomial of the leaf's size cannot
/// follow, and together such places may be too small for points spread by area to notice. What touches a leaf is no gap
/// (`ContactLines`). 1 of such leaves, 0 of others and of inner elements; the same on any number of threads.
/// O(leaves): four rays each.
Field<ElementId, std::uint8_t> find_narrow_leaves(const Stage& stage, const ElementTree& tree);

struct DirectProjection;

/// The share of what surfaces reflect of direct light that leaves leaves of the projection's mesh which are more
/// than twice as wide as the gap over them is high: between slats of a blind, not in rooms. What shines there comes
/// back from the other side of the gap before distance evens it out. From some thousand leaves at even steps; four rays
/// each.
double share_of_light_in_gaps(const Stage& stage, const DirectProjection& direct);

}  // namespace exitance
