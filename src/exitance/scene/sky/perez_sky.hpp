#pragma once

#include "exitance/scene/sky/sky_model.hpp"

namespace exitance {

/// Returns Perez' sky for a clearness (at least 1) and a brightness (above 0); the sun must not be below the horizon
/// [Perez93].
SkyModel perez_sky_of(const PerezState& state, const Normal& sun);

}  // namespace exitance
