#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/evaluate/radiosity_function.hpp"

namespace exitance {

/// How far a solution's irradiance is off at most places.
struct ErrorPercentile {
    double median = 0, p99 = 0;  ///< Of |E - E'|, mean over the bands, relative to the mean of E over all places.
    double noise = 0;            ///< RMS standard error of E' in the same measure: it is part of the above.
    std::size_t points = 0;
};

/// Compares E with E' = E_dir + H b, exact direct light and a gather of its own, at `count` places uniform in area that
/// lie in the open: the residual of the radiosity equation there, which is the error but for what the light gathered is
/// off as a whole. `rays` a place, a power of two. O(count x rays).
ErrorPercentile find_error_percentile(const RadiosityFunction& light, std::size_t count, unsigned rays,
                                      Progress& progress, const StopRequest& stop);

}  // namespace exitance
