#pragma once

#include <span>
#include <vector>

#include "exitance/direct/crowded_light.hpp"

namespace exitance {

/// Light of crowded sources at places that one polynomial is fitted to, with rays spent where light is. For areas a_j
/// with the light E_j, the fewest rays for an error in the mean square are in proportion to E_j, and so are the squared
/// errors e_j^2:
///
///     e_j^2 = e^2 (1 + E_j / E) / 2,    sum a_j e_j^2 = e^2 sum a_j,
///
/// with the mean light E. A place may err by more than the fit, which keeps a part of the places' noise. Four rays a
/// place tell E_j to begin with.
/// crowd       of `light`; its `allowed` is e^2, (W/m^2)^2, and what the fit may keep
/// kept        part of the variance of its places that the fit keeps, in (0, 1]
/// mean_light  E, mean over bands, W/m^2; > 0
/// O(places x rays)
std::vector<CrowdedLight::Estimate> estimates_by_light(const CrowdedLight& by_rays, const ReceiverLight& light,
                                                       const CrowdedLight::Crowd& crowd, std::span<const Point> places,
                                                       double kept, double mean_light, DirectLight::Workspace& scratch);

}  // namespace exitance
