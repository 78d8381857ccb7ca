#pragma once

#include <vector>

#include "exitance/visibility/occluders.hpp"

namespace exitance {

/// Largest area such that all areas up to it sum to at most `unfindable`. Faces up to that area may be wrong, since no
/// table of sample points would find them. Zeros are ignored. O(n log n).
double min_findable(std::vector<double> areas, double unfindable);

/// Number of different ids in `pieces`.
std::size_t count_different(std::vector<PieceId> pieces);

}  // namespace exitance
