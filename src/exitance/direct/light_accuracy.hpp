#pragma once

#include "exitance/calibration/error_budget.hpp"

namespace exitance {

/// Allowed RMS error of light at a place: relative * E + absolute.
struct LightAccuracy {
    double relative = 0;
    double absolute = 0;          ///< Absolute error, W/m^2, mean over bands.
    unsigned max_rays = 1 << 13;  ///< Maximum number of rays, which limits the cost of nearly hidden sources.

    double allowed(double E) const { return relative * E + absolute; }
};

/// Accuracy for single places of a solution with the relative error `error`.
inline LightAccuracy point_accuracy(double error) {
    return {.relative = ErrorBudget(error).direct_at_point()};
}

}  // namespace exitance
