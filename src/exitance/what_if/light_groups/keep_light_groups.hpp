#pragma once

#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {

/// Error (usage) if the scene has more than `max_light_groups` groups that emit.
Result<void> check_light_groups(const Scene& scene);

/// Solves the light groups of a solution and records their size and time in its statistics. The solution loses its
/// discontinuity mesh and the method's own form of light, which hold the light of all groups together. Returns no
/// groups for a dark scene, or if a stop was requested first; a warning is then recorded.
Result<LightGroups> keep_light_groups(Solution& solution, const SolveOptions& options, Progress& progress,
                                      const StopRequest& stop);

/// Energy balance of a solution after change_light(), from its exported mesh; zero with light from outside.
EnergyBalance energy_after_change(const Solution& solution);

}  // namespace exitance
