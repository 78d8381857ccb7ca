#pragma once

#include "exitance/transport/direct_projection.hpp"

namespace exitance {

/// RMS error of rho E_dir over all surfaces, W/m^2, that clusters of emitters leave where light is asked for at points
/// with this accuracy; 0 where all of it is exact. Asked at a few hundred leaves of `direct`, spread over their area.
double clustering_error(const Stage& stage, const DirectProjection& direct, const LightAccuracy& accuracy);

}  // namespace exitance
