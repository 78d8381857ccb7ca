#pragma once

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// Cuts a leaf that is found too coarse: a parallelogram across its longer direction, or both where they are alike; a
/// triangle into four; a cell across its longest extent. Returns its children.
IdRange<ElementId> refine_element(ElementTree& tree, ElementId leaf);

}  // namespace exitance
