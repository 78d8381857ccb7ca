#pragma once

#include "exitance/transport/direct_projection.hpp"

namespace exitance {

/// Returns the RMS error of rho E_dir over all surfaces, W/m^2, that is due to the noise of rays where direct light is
/// evaluated at points with this accuracy; 0 if all direct light is exact. Estimated at a few hundred leaves of
/// `direct`, distributed over their area.
double direct_light_noise(const Stage& stage, const DirectProjection& direct, const LightAccuracy& accuracy);

}  // namespace exitance
