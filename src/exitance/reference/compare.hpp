#pragma once

#include <span>
#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Irradiance of a result and of its reference at the same points, W/m^2.
struct ErrorSamples {
    std::span<const Spectrum> irradiance;
    std::span<const Spectrum> reference;
    std::span<const Spectrum> standard_errors;  ///< Standard errors of the reference; empty: the reference is exact.
    std::span<const SurfaceId> surfaces;        ///< The face at each point; none: the point is in free space.
};

/// Difference between a result and its reference. All values except `points` are relative: 0.01 is 1%.
struct ErrorMeasure {
    double relative_rms_error = 0;      ///< sqrt(max(0, raw^2 - noise^2))
    double raw_relative_rms_error = 0;  ///< sqrt(mean (B - B_ref)^2) / mean (B_ref - M)
    double reference_noise = 0;         ///< sqrt(mean (rho se)^2) / mean (B_ref - M)
    double bias = 0;                    ///< mean (B - B_ref) / mean (B_ref - M)
    double median_relative_error = 0;   ///< Median error of E over the points with E_ref > 0.
    double p95_relative_error = 0;
    std::size_t points = 0;
    bool of_irradiance = false;  ///< True if nothing reflects, so that E was used in place of B.
};

/// Returns the error measure over points that are uniform in area, all bands together, with B - B_ref = rho (E - E_ref)
/// and B_ref - M = rho E_ref. If nothing reflects, E is used in place of B. The error of one point is sqrt(mean over
/// bands (E - E_ref)^2) / mean over bands E_ref. Points in free space are skipped, unless all points are in free space:
/// then E is used. All spans have one entry per point, or may be empty if documented so. All values are infinite if a
/// result is not finite, or if it is not 0 and the reference is 0 at all points. O(n log n).
ErrorMeasure measure_error(const ErrorSamples& samples, const Scene& scene);

}  // namespace exitance
