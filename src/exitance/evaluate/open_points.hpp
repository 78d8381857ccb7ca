#pragma once

#include "exitance/transport/stage.hpp"

namespace exitance {

/// Is a point in the open: does neither another surface lie on it, nor a body around it? x lies on region `region`, or
/// in free space where that is none. Inside a body rays to all sides end on backs, and the one straight up ends
/// somewhere: bodies stand open where they touch others, such as the legs of a table. One to five rays.
bool is_in_open(const Stage& stage, const Point& x, const Normal& n, RegionId region);

}  // namespace exitance
