#pragma once

#include <optional>

#include "exitance/methods/methods.hpp"

namespace exitance {

/// Radiosity over links found by rays (`link_by_rays`): constant elements on the mesh of the direct light, whose light
/// has to be gathered once more. It takes a third of the rays of `matrix`, distributed over the hierarchy.
///
/// `unless_open`: returns nothing if most light is unoccluded (`is_mostly_open`). Links that are judged one by one are
/// then as exact as required, and no gather is needed. O(rays log rays).
///
/// With several processes, each casts the rows of its own leaves, finds their links, and gathers over these.
std::optional<GlobalLight> solve_linked_by_rays(const MethodInput& input, bool unless_open);

}  // namespace exitance
