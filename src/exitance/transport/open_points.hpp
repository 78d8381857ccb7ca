#pragma once

#include "exitance/transport/stage.hpp"

namespace exitance {

/// True if a point is neither covered by another surface nor inside a body. `region`: the region that contains x, or
/// none for a point in free space. Inside a body rays in all directions hit backs, and the ray along n hits some
/// surface: bodies may be open where they touch others, such as the legs of a table. Casts one to nine rays.
bool is_in_open(const Stage& stage, const Point& x, const Normal& n, RegionId region);

}  // namespace exitance
