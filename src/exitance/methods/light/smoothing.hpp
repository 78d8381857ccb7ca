#pragma once

#include "exitance/solution/solution.hpp"
#include "exitance/solve/global_light.hpp"

namespace exitance {

/// Reconstructs the indirect light of constant elements as a linear function on every leaf: second order where light is
/// smooth, with jumps preserved. A leaf's slope is the smallest of those through its value and two adjacent neighbours,
/// so that it is taken from the leaf's own side of a shadow edge. It is limited so that values at corners stay within
/// the range of the neighbours. Neighbours are leaves of the same region; means are preserved. Source: essentially
/// non-oscillatory reconstruction [Abgrall94], limiter of [Barth89]. O(leaves).
ElementFunction smoothed_on_leaves(const GlobalLight& light, std::size_t region_count);

}  // namespace exitance
