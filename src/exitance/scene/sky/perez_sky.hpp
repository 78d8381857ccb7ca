#pragma once

#include "exitance/scene/sky/sky_model.hpp"

namespace exitance {

/// Returns Perez' sky for a clearness (at least 1) and a brightness (above 0); the sun must not be below the horizon
/// [Perez93].
SkyModel perez_sky_of(const PerezState& state, const Normal& sun);

/// Returns perez_sky() with `scale` 1. For callers of value() only: finding the scale takes a thousand evaluations.
SkyModel unscaled_perez_sky(const PerezInput& input, const Normal& sun);

/// True if the value of a sky is the product of its gradation and its indicatrix, but at least 0.
bool is_product(const SkyModel& sky);
/// Returns phi(Z) of a sky, with z = cos Z [Darula02].
double gradation(const SkyModel& sky, double z);
/// Returns f(gamma) of a sky, with the cosine of the angle from the sun [Darula02].
double indicatrix(const SkyModel& sky, double cos_gamma);

}  // namespace exitance
