#pragma once

#include <vector>

#include "exitance/visibility/occluders.hpp"

namespace exitance {

/// The largest area at or below which all areas together come to no more than `unfindable`: what is that small may be
/// wrong, since no table of points would find it. Zeros do not count. O(n log n).
double least_findable(std::vector<double> areas, double unfindable);

std::size_t count_different(std::vector<PieceId> pieces);

}  // namespace exitance
