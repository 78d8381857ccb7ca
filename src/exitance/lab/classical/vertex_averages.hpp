#pragma once

#include "exitance/solution/solution.hpp"

namespace exitance {

/// A function as papers display it: at every corner the mean over the leaves of its region that have a corner there,
/// (bi)linear in between. Corners that stand on a neighbour's edge keep what meets there. O(leaves log leaves).
ElementFunction averaged_at_vertices(const ElementFunction& function, double rounding);

}  // namespace exitance
