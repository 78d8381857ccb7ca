#pragma once

#include "exitance/transport/direct_projection.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {

/// Estimates how far each group's light is from the radiosity equation, as `Certifier` does of a whole solution: from
/// two independent gathers of what it reflects at points that are stratified over the surfaces, and the response of
/// kept transport to the regions' mean residuals. All groups share points and rays. Fills in `error` and needs
/// `reflected`; a group that no light reaches has none. `direct[g]`: of the sources of the layout; `older[g]`: what
/// those reflect to be gathered, where reflections are counted, else empty. O(points x rays).
void estimate_group_errors(const Stage& stage, const Solution& solution,
                           const std::vector<std::vector<DirectFit>>& direct,
                           const std::vector<std::vector<Spectrum>>& older, double error, std::uint64_t seed,
                           LightGroups& groups, const StopRequest& stop);

}  // namespace exitance
