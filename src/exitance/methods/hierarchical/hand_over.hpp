#pragma once

#include "exitance/methods/hierarchical/hierarchy.hpp"

namespace exitance {

/// Writes light, links and what they took to `hierarchy.light`, as every method hands it on. Leaves are cut, where
/// quadratic functions are delivered, until linear ones hold them.
void hand_over(Hierarchy& hierarchy);

}  // namespace exitance
