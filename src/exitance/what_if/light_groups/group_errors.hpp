#pragma once

#include "exitance/transport/direct_projection.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {

/// Estimates the error of each group's light, as `Certifier` does for a whole solution: from two independent gathers of
/// its reflected light at points stratified over the surfaces, and from the response of the stored transport to the
/// regions' mean residuals. All groups share points and rays. `direct[g]`: direct light on the sources of the layout;
/// `older[g]`: reflected light to be gathered if the number of bounces is limited, otherwise empty. `groups`:
/// `reflected` must be set; `error` is filled in, except for groups that light no surface. O(points x rays).
void estimate_group_errors(const Stage& stage, const Solution& solution,
                           const std::vector<std::vector<DirectFit>>& direct,
                           const std::vector<std::vector<Spectrum>>& older, double error, std::uint64_t seed,
                           LightGroups& groups, const StopRequest& stop);

}  // namespace exitance
