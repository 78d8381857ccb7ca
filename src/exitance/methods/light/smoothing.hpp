#pragma once

#include "exitance/solution/solution.hpp"
#include "exitance/solve/global_light.hpp"

namespace exitance {

/// The indirect light of constant elements as a linear function on every leaf: second order where light is smooth,
/// while its jumps stay. A leaf's slope is the least of those that its value and two neighbours' side by side give, so
/// that it is taken on the side of a shadow's edge on which the leaf lies; and so limited that nothing at the leaf's
/// corners passes all of its neighbours. Neighbours are leaves of the same region; means stay as they are.
/// Source: essentially non-oscillatory reconstruction [Abgrall94], limiter of [Barth89]. O(leaves).
ElementFunction smoothed_on_leaves(const GlobalLight& light, std::size_t region_count);

}  // namespace exitance
