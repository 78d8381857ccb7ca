#pragma once

#include "exitance/solution/solution.hpp"

namespace exitance {

/// A function as papers display it: at every corner the mean over the leaves of its region that have a corner there,
/// (bi)linear in between. A corner on a neighbour's edge averages only the leaves with a corner there. `rounding`:
/// distance within which corners are equal, metres. O(leaves log leaves).
ElementFunction averaged_at_vertices(const ElementFunction& function, double rounding);

}  // namespace exitance
