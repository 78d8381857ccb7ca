#pragma once

#include <span>

#include "exitance/evaluate/surface_light.hpp"

namespace exitance {

/// The part of the error that stems from pictures: a face reflects the mean of what it shows. Relative RMS error of
/// radiosity, like SolveStatistics::relative_error_estimate:
///
///     sqrt(sum_f A_f mean_b (s_f E_f)^2 / sum_f A_f) / (sum_f A_f mean_b rho_f E_f / sum_f A_f)
///
/// over faces f and bands b; s_f is the deviation of reflectance over the face, and E_f its mean irradiance. Light that
/// reaches other faces from there is not counted: the deviations have no mean, so that little of them is left where
/// their light arrives.
/// deviation  by material, RMS; missing ones are 0
double texture_error(const Scene& scene, const Field<SurfaceId, SurfaceLight>& light,
                     std::span<const Spectrum> deviation);

/// Adds that part to the estimates of a solution (in quadrature), and says so in a warning if it is more than a tenth
/// of the estimate. A solution whose estimate is above `demand` then has not converged.
void add_texture_error(Solution& solution, std::span<const Spectrum> deviation, std::optional<double> demand);

}  // namespace exitance
