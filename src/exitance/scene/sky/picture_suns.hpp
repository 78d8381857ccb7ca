#pragma once

#include <vector>

#include "exitance/scene/sky/directional_picture.hpp"

namespace exitance {

/// Finds small, very bright spots of a picture, such as the sun and lamps, and replaces them by their surroundings.
/// Returns a disc for each, the brightest first, at most 16.
///
/// A spot is the connected set of pixels around a maximum that have at least a twentieth of its radiance. It becomes a
/// disc if the maximum is far above the mean radiance of the rest of the picture, if the solid angle is small, and if
/// its light is not negligible.
std::vector<DistantLight::Disc> take_suns(DirectionalPicture& picture, double rotation);

}  // namespace exitance
