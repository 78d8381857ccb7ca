#pragma once

#include "exitance/transport/stage.hpp"

namespace exitance {

/// The leaves that are large beside the gap over them: somewhere on the leaf something stands in front of it, nearer
/// than the leaf is wide. Light turns there within the height of the gap, which a polynomial of the leaf's size cannot
/// follow, and together such places may be too small for points spread by area to notice. What touches a leaf is no gap
/// (`ContactLines`). 1 of such leaves, 0 of others and of inner elements; the same on any number of threads.
/// O(leaves): four rays each.
Field<ElementId, std::uint8_t> find_narrow_leaves(const Stage& stage, const ElementTree& tree);

}  // namespace exitance
