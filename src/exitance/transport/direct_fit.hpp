#pragma once

#include "exitance/direct/sampled_light.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {

/// Limits on the noise that a fit may keep, if light is estimated by rays (`PlaceLight`).
struct NoiseAllowed {
    double squared = 0;  ///< Largest mean square of w (E - polynomial) due to noise, (W/m^2)^2; 0: exact light.
    double mean_light =  ///< Mean of w E over all surfaces, W/m^2, if noise is allotted in proportion to light; else 0.
        0;
    /// Elements smaller than this, m^2, matter only together: the light that their nodes miss averages out.
    double minor_area = 0;
};

/// Rays of an element to weak sources. Elements larger than the mean get more.
constexpr unsigned rays_an_element = 16;

/// Like `fit_direct_light`, with limits on noise.
DirectFit fit_all_light(const Stage& stage, const ElementTree& tree, ElementId e, const NoiseAllowed& allowed,
                        DirectFitRoom& room);

/// Like `fit_all_light`, for scenes of many elements: sources that contribute little to this element are only sampled,
/// by `rays` rays together.
DirectFit fit_strong_light(const Stage& stage, const ElementTree& tree, ElementId e, const NoiseAllowed& allowed,
                           unsigned rays, SampledLight& sampled, DirectFitRoom& room);

/// Returns a constant fit from rays alone, for work that is stopped early.
DirectFit fit_by_rays(const Stage& stage, const ElementTree& tree, ElementId e, SampledLight& sampled);

}  // namespace exitance
