#pragma once

#include <span>

#include "exitance/evaluate/surface_light.hpp"

namespace exitance {

/// Returns the part of the error due to textures, as each face reflects with the mean of its texture. Relative RMS
/// error of radiosity, like SolveStatistics::relative_error_estimate:
///
///     sqrt(sum_f A_f mean_b (s_f E_f)^2 / sum_f A_f) / (sum_f A_f mean_b rho_f E_f / sum_f A_f)
///
/// over faces f and bands b; s_f is the standard deviation of reflectance over the face, and E_f its mean irradiance.
/// The effect on the light of other faces is neglected: the deviations have zero mean, so that they nearly cancel
/// there.
/// deviation  RMS deviation of reflectance per material; missing entries are 0
double texture_error(const Scene& scene, const Field<SurfaceId, SurfaceLight>& light,
                     std::span<const Spectrum> deviation);

/// Adds the error due to textures to the estimates of a solution (in quadrature), and adds a warning if it is more than
/// a tenth of the estimate. Marks the solution as not converged if its estimate then exceeds `demand`.
void add_texture_error(Solution& solution, std::span<const Spectrum> deviation, std::optional<double> demand);

}  // namespace exitance
