#pragma once

#include <optional>

#include "exitance/methods/methods.hpp"

namespace exitance {

/// Radiosity over links that rays have found (`link_by_rays`): constant elements on the mesh of the direct light, whose
/// light is to be gathered once more. Rays are a third of those that `matrix` casts, dealt out over the hierarchy.
///
/// `unless_open`: none where light is mostly in the open (`is_mostly_open`). There links that are judged one by one
/// give it as exactly as it is asked for, and nothing has to be gathered. O(rays log rays).
///
/// Over several processes each casts the rows of its own leaves, finds their links, and gathers over these.
std::optional<GlobalLight> solve_linked_by_rays(const MethodInput& input, bool unless_open);

}  // namespace exitance
