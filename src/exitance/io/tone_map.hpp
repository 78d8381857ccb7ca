#pragma once

#include <array>

#include "exitance/core/spectrum.hpp"
#include "exitance/reconstruct/solution.hpp"

namespace exitance {

using DisplayColour = std::array<double, 3>;  ///< Linear red, green, blue in [0, 1].

/// From light to what a display shows: L_d = s L (1 + s L / w^2) / (1 + s L), applied to the mean of the bands, hue
/// kept; then clamped. Source: [Reinhard02], equation 4.
struct ToneMap {
    double scale = 1;  ///< s: display units per W/m^2.
    double white = 4;  ///< w: what s L is shown as white.

    DisplayColour operator()(const Spectrum& light) const;
};

/// The scale at which a scene's reflected light lies around middle grey: 0.18 over its logarithmic mean by area.
/// Emitters are left out of the mean.
ToneMap make_tone_map(const Solution& solution);

/// The sRGB encoding of a linear value in [0, 1].
double srgb_encoded(double linear);

}  // namespace exitance
