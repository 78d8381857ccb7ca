#pragma once

#include <vector>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// Sorts elements along a Morton curve through their centres, so that those that follow each other are neighbours:
/// their rays visit the same parts of a scene. Elements of one cell keep their order. O(n log n).
void sort_by_place(const ElementTree& tree, std::vector<ElementId>& elements);

}  // namespace exitance
