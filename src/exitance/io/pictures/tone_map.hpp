#pragma once

#include <array>

#include "exitance/base/spectrum.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

using DisplayColour = std::array<double, 3>;  ///< Linear red, green, blue in [0, 1].

/// The bands used as red, green and blue. If the number of bands is not three, these are the first, the middle and the
/// last.
inline std::array<double, 3> red_green_blue(const Spectrum& s) {
    return {s[0], s[(bands - 1) / 2], s[bands - 1]};
}

enum class ToneCurve : std::uint8_t {
    photographic,  ///< s L (1 + s L / w^2) / (1 + s L) for the mean of the bands, which keeps the hue.
                   ///< Source: [Reinhard02], equation 4.
    filmic,        ///< x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14) for every band, x = 0.7232 s L. [Narkowicz15]
    linear,        ///< Displays s L; values above white are clipped.
};

/// Converts light to display colours. All curves ascend and map 0.18 to about 0.18; results are clamped to [0, 1].
struct ToneMap {
    double scale = 1;  ///< Factor s: display units per W/m^2.
    double white = 4;  ///< w: value of s L that is shown as white by the photographic curve.
    ToneCurve curve = ToneCurve::photographic;

    DisplayColour operator()(const Spectrum& light) const;
};

/// Makes a tone map that brings the scene's reflected light to middle grey: the scale is 0.18 over the area-weighted
/// logarithmic mean, without emitters.
ToneMap make_tone_map(const Solution& solution);

/// The sRGB encoding of a linear value in [0, 1].
double srgb_encoded(double linear);

}  // namespace exitance
