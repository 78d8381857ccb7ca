#pragma once

#include "exitance/scene/emitter_groups.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {

/// The scene with nothing but a group's light.
Scene alone(const Scene& scene, const EmitterGroup& group);

/// Direct light of a scene that is that of the stage under other light, on elements that are there: exact, but where
/// clusters and rays find it for less. `tolerance`: RMS error of rho E_dir that these may leave, relative to its mean.
/// Some fits stay dark once a stop is asked for. O(elements x places x visible emitters).
std::vector<DirectFit> fit_direct_of(const Scene& lit, const Stage& stage, const ElementTree& tree,
                                     std::span<const ElementId> elements, double tolerance, std::uint64_t seed,
                                     const StopRequest& stop);

}  // namespace exitance
