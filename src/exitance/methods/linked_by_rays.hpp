#pragma once

#include <optional>

#include "exitance/methods/methods.hpp"

namespace exitance {

/// Radiosity over links that rays have found (`link_by_rays`): constant elements on the mesh of the direct light, whose
/// light is to be gathered once more. Rays are a third of those that `matrix` casts, dealt out over the hierarchy.
///
/// None where `open_share` is given and more of the light than that passes in the open: there links that are judged one
/// by one give light as exactly as it is asked for, and nothing has to be gathered. O(rays log rays).
std::optional<GlobalLight> solve_linked_by_rays(const MethodInput& input, std::optional<double> open_share);

}  // namespace exitance
