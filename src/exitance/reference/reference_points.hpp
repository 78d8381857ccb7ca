#pragma once

#include <span>
#include <vector>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/reference/compare.hpp"

namespace exitance {

/// What a solution is held against.
struct ReferencePoints {
    std::vector<ProbePoint> points;
    std::vector<Spectrum> irradiance;       ///< W/m^2
    std::vector<Spectrum> standard_errors;  ///< W/m^2; empty: exact.
};

/// What of a solution is measured: the function that `probe` evaluates, or what `export` writes.
enum class Evaluated : std::uint8_t { function, interpolant };

/// E of a solution at points, W/m^2.
std::vector<Spectrum> irradiance_at(const Solution& solution, const std::vector<ProbePoint>& points,
                                    Evaluated what = Evaluated::function);

/// How far irradiance at the reference's points is from it, W/m^2.
ErrorMeasure error_against(std::span<const Spectrum> irradiance, const ReferencePoints& reference, const Scene& scene);
ErrorMeasure error_against(const Solution& solution, const ReferencePoints& reference,
                           Evaluated what = Evaluated::function);

}  // namespace exitance
