#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/evaluate/radiosity_function.hpp"

namespace exitance {

/// Error of a solution's irradiance at typical places.
struct ErrorPercentile {
    /// Percentiles of |E - E'|, mean over bands, relative to the mean of E over all places.
    double median = 0, p99 = 0;
    double noise = 0;  ///< RMS standard error of E', in the same measure; included in the percentiles.
    std::size_t points = 0;
};

/// Compares E with E' = E_dir + H b (exact direct light and a new gather) at `count` places that are uniform in area;
/// covered places are skipped. The difference is the residual of the radiosity equation. It equals the error except for
/// a common error of the gathered light. `rays`: per place, a power of two. O(count x rays).
ErrorPercentile find_error_percentile(const RadiosityFunction& light, std::size_t count, unsigned rays,
                                      Progress& progress, const StopRequest& stop);

}  // namespace exitance
