#pragma once

#include "exitance/scene/sky/sky_model.hpp"

namespace exitance {

/// Perez' sky of a clearness (from 1) and a brightness (above 0); the sun is not below the horizon [Perez93].
SkyModel perez_sky_of(const PerezState& state, const Normal& sun);

}  // namespace exitance
