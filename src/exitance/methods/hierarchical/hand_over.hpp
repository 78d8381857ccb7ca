#pragma once

#include "exitance/methods/hierarchical/hierarchy.hpp"

namespace exitance {

/// Writes light, links and work counts to `hierarchy.light`, in the form that every method returns. If quadratic
/// functions are delivered, leaves are first split until linear functions approximate them.
void hand_over(Hierarchy& hierarchy);

}  // namespace exitance
