#pragma once

#include <algorithm>

namespace exitance {

/// Allowed RMS error of light at a place: relative * E + absolute.
struct LightAccuracy {
    double relative = 0;
    double absolute = 0;          ///< Absolute error, W/m^2, mean over bands.
    unsigned max_rays = 1 << 13;  ///< Maximum number of rays, which limits the cost of nearly hidden sources.

    double allowed(double E) const { return relative * E + absolute; }
};

/// Accuracy for single places of a solution with the relative error `error`. Independent noise of a fifth of the error
/// makes it larger by 2%.
constexpr LightAccuracy point_accuracy(double error) {
    constexpr double part = 0.2, least = 2e-4, most = 0.01;
    return {.relative = std::clamp(part * error, least, most)};
}

}  // namespace exitance
