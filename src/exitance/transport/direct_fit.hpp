#pragma once

#include "exitance/direct/sampled_light.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {

/// A fit, and how much of its misfit is noise that it keeps, (W/m^2)^2: more rays would help, smaller elements would
/// not.
struct NoisyFit {
    DirectFit fit;
    double noise = 0;
};

/// What noise of rays to crowded sources a fit may keep.
struct NoiseAllowed {
    double squared = 0;     ///< Mean square of w (E - polynomial) that noise may leave, (W/m^2)^2; 0: exact.
    double mean_light = 0;  ///< Mean of w E over all surfaces, W/m^2, where it is dealt out by light; else 0.
};

/// For weak sources; more on elements larger than the first ones on average.
constexpr unsigned rays_an_element = 16;

/// As `fit_direct_light` has it.
NoisyFit fit_all_light(const Stage& stage, const ElementTree& tree, ElementId e, const NoiseAllowed& allowed,
                       DirectFitRoom& room);

/// The same where there are many elements: sources that do not count on this one are left to rays, so many of them.
NoisyFit fit_strong_light(const Stage& stage, const ElementTree& tree, ElementId e, const NoiseAllowed& allowed,
                          unsigned rays, SampledLight& sampled, DirectFitRoom& room);

/// By rays alone, constant: for work that is cut short.
DirectFit fit_by_rays(const Stage& stage, const ElementTree& tree, ElementId e, SampledLight& sampled);

}  // namespace exitance
