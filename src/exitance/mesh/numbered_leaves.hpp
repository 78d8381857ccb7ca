#pragma once

#include "exitance/mesh/element_locator.hpp"
#include "exitance/mesh/solve_mesh.hpp"

namespace exitance {

/// Elements of a mesh, the numbers of their leaves, and the leaf at a point. Refers to objects that must last longer.
struct NumberedLeaves {
    const ElementTree& tree;
    const LeafNumbering& numbering;
    const ElementLocator& locator;
};

}  // namespace exitance
