#pragma once

#include <array>

#include "exitance/base/spectrum.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

using DisplayColour = std::array<double, 3>;  ///< Linear red, green, blue in [0, 1].

/// The bands that stand for red, green and blue: of other counts than three the ends and the middle.
inline std::array<double, 3> red_green_blue(const Spectrum& s) {
    return {s[0], s[(bands - 1) / 2], s[bands - 1]};
}

enum class ToneCurve : std::uint8_t {
    photographic,  ///< s L (1 + s L / w^2) / (1 + s L) on the mean of the bands, hue kept. [Reinhard02], equation 4.
    filmic,        ///< x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14) on every band, x = 0.7232 s L. [Narkowicz15]
    linear,        ///< s L, what is brighter than white clipped.
};

/// From light to what a display shows. All curves show 0.18 near 0.18 and rise; results are clamped to [0, 1].
struct ToneMap {
    double scale = 1;  ///< s: display units per W/m^2.
    double white = 4;  ///< w: what s L is shown as white; of the photographic curve.
    ToneCurve curve = ToneCurve::photographic;

    DisplayColour operator()(const Spectrum& light) const;
};

/// The scale at which a scene's reflected light lies around middle grey: 0.18 over its logarithmic mean by area.
/// Emitters are left out of the mean.
ToneMap make_tone_map(const Solution& solution);

/// The sRGB encoding of a linear value in [0, 1].
double srgb_encoded(double linear);

}  // namespace exitance
