#pragma once

#include "exitance/transport/direct_projection.hpp"

namespace exitance {

/// Direct light that is fitted on elements of a stage: of all its emitters, or of some of them.
struct FittedLight {
    FittedLight(const Stage& s) : FittedLight(s, s.direct, s.place_light) {}
    FittedLight(const Stage& s, const DirectLight& d, const PlaceLight& p) : stage(s), direct(d), places(p) {}

    const Stage& stage;
    const DirectLight& direct;
    const PlaceLight& places;
};

/// Limits on the noise that a fit may keep, if light is estimated by rays (`PlaceLight`).
struct NoiseAllowed {
    double squared = 0;  ///< Largest mean square of w (E - polynomial) due to noise, (W/m^2)^2; 0: exact light.
    double mean_light =  ///< Mean of w E over all surfaces, W/m^2, if noise is allotted in proportion to light; else 0.
        0;
    /// Elements smaller than this, m^2, matter only together: the light that their nodes miss averages out.
    double minor_area = 0;
};

/// Accuracy of light at a node of an element's rule, or of its mean; `w`: mean of its light_weight(). Noise that is
/// allotted by light has the squared error e^2 (1 + E / mean E) / 2: its root is at most this linear function, which is
/// equal at E = 0 and at the mean.
LightAccuracy accuracy_on(double w, const NoiseAllowed& allowed);

/// Rays of an element to weak sources. Elements larger than the mean get more.
constexpr unsigned rays_an_element = 16;

/// Like `fit_direct_light`, with limits on noise.
DirectFit fit_all_light(const FittedLight& light, const ElementTree& tree, ElementId e, const NoiseAllowed& allowed,
                        DirectFitRoom& room);

/// Like `fit_all_light`, for scenes of many elements: sources that contribute little to this element are only sampled,
/// by `rays` rays together. Sky, sun and punctual lights are left out.
DirectFit fit_strong_light(const FittedLight& light, const ElementTree& tree, ElementId e, const NoiseAllowed& allowed,
                           unsigned rays, DirectFitRoom& room);

/// Returns a constant fit from a few rays at a random place, for work that is stopped early.
DirectFit fit_by_rays(const FittedLight& light, const ElementTree& tree, ElementId e, DirectFitRoom& room);

/// Estimates the mean of w E_dir over leaves, W/m^2, w the light_weight(), by a few rays at each of some thousand
/// places. Returns 0 on a request to stop.
double mean_weighted_light(const FittedLight& light, const ElementTree& tree, std::span<const ElementId> leaves,
                           const StopRequest& stop);

}  // namespace exitance
