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
    std::span<const Spectrum> standard_errors;  ///< Of the reference; empty means exact.
    std::span<const SurfaceId> surfaces;        ///< The face that each point lies on, none for one in free space.
};

/// How far a result is from its reference; every figure but the counts is relative, 0.01 meaning 1%.
struct ErrorMeasure {
    double relative_rms_error = 0;      ///< sqrt(max(0, raw^2 - noise^2))
    double raw_relative_rms_error = 0;  ///< sqrt(mean (B - B_ref)^2) / mean (B_ref - M)
    double reference_noise = 0;         ///< sqrt(mean (rho se)^2) / mean (B_ref - M)
    double bias = 0;                    ///< mean (B - B_ref) / mean (B_ref - M)
    double median_relative_error = 0;   ///< Of E, over the points whose E_ref is not 0.
    double p95_relative_error = 0;
    std::size_t points = 0;
    bool of_irradiance = false;  ///< Nothing reflects: E stood for B.
};

/// The error measure over points that are uniform in area, all bands together, with B - B_ref = rho (E - E_ref) and
/// B_ref - M = rho E_ref. Where nothing reflects, E takes the place of B. The error of one point is
/// sqrt(mean over bands (E - E_ref)^2) / mean over bands E_ref. Points in free space are left out, unless all are: then
/// E is measured. Everything is infinite when a result is not finite, or deviates from a reference that is 0
/// throughout. O(n log n). All spans are of one size, or empty where that is said.
ErrorMeasure measure_error(const ErrorSamples& samples, const Scene& scene);

/// The same over the points of each face that has any, by face.
struct SurfaceError {
    SurfaceId surface;
    ErrorMeasure error;
};
std::vector<SurfaceError> measure_error_by_surface(const ErrorSamples& samples, const Scene& scene);

}  // namespace exitance
