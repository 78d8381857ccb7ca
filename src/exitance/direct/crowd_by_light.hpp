#pragma once

#include <span>
#include <vector>

#include "exitance/direct/crowded_light.hpp"

namespace exitance {

/// Estimates the light of crowded sources at points to which one polynomial is fitted, with more rays where there is
/// more light. For areas a_j with the light E_j, a given mean square error needs fewest rays if the rays, and the
/// squared errors e_j^2, are in proportion to E_j:
///
///     e_j^2 = e^2 (1 + E_j / E) / 2,    sum a_j e_j^2 = e^2 sum a_j,
///
/// with the mean light E. A point may have a larger error than the fit, which keeps only a part of the points' noise.
/// E_j is first estimated by four rays per point.
/// crowd       sources of `light`; its `allowed` is e^2, the variance allowed in the fit, (W/m^2)^2
/// kept        share of the variance of its points that the fit keeps, in (0, 1]
/// mean_light  E, mean over bands, W/m^2; > 0
/// O(points x rays)
std::vector<CrowdedLight::Estimate> estimates_by_light(const CrowdedLight& by_rays, const ReceiverLight& light,
                                                       const CrowdedLight::Crowd& crowd, std::span<const Point> places,
                                                       double kept, double mean_light, DirectLight::Workspace& scratch);

}  // namespace exitance
