#pragma once

#include <span>
#include <vector>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/reference/compare.hpp"

namespace exitance {

/// Reference with which a solution is compared.
struct ReferencePoints {
    std::vector<ProbePoint> points;
    std::vector<Spectrum> irradiance;       ///< W/m^2
    std::vector<Spectrum> standard_errors;  ///< W/m^2; empty: the reference is exact.
};

/// The part of a solution that is compared: the function that `probe` evaluates, or the mesh that `export` writes.
enum class Evaluated : std::uint8_t { function, interpolant };

/// Returns the irradiance of a solution at points, W/m^2.
std::vector<Spectrum> irradiance_at(const Solution& solution, const std::vector<ProbePoint>& points,
                                    Evaluated what = Evaluated::function);

/// Compares irradiance at the reference's points, W/m^2, with the reference.
ErrorMeasure error_against(std::span<const Spectrum> irradiance, const ReferencePoints& reference, const Scene& scene);
ErrorMeasure error_against(const Solution& solution, const ReferencePoints& reference,
                           Evaluated what = Evaluated::function);

}  // namespace exitance
