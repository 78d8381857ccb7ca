#pragma once

#include "exitance/scene/emitter_groups.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {

/// Returns the scene with the group's light only.
Scene alone(const Scene& scene, const EmitterGroup& group);

/// Computes direct light on elements for a scene that equals the stage's except for its lights. It is exact unless
/// clusters or rays are cheaper. `tolerance`: permitted RMS error of rho E_dir by these, relative to its mean. Some
/// fits stay dark after a request to stop. O(elements x points x visible emitters).
std::vector<DirectFit> fit_direct_of(const Scene& lit, const Stage& stage, const ElementTree& tree,
                                     std::span<const ElementId> elements, double tolerance, const StopRequest& stop);

}  // namespace exitance
