#pragma once

#include "exitance/measure/glare/glare.hpp"

namespace exitance {

/// Moves an eye on a wall away from it: otherwise rays would hit the wall at distance zero.
Observer off_walls(const RadiosityFunction& light, const Observer& observer);

/// Returns the indirect illuminance perpendicular to the line of sight: the mean over several points near the eye, each
/// with its own rays. Points beyond a wall are replaced by the eye.
double indirect_at_eye(const RadiosityFunction& light, const Observer& observer, const LightUnit& lux);

}  // namespace exitance
