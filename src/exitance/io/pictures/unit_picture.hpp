#pragma once

#include "exitance/measure/pictures/picture.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {

/// Converts the light of a picture to one number in `unit`, stored in all bands, so that any mean of bands gives that
/// number.
Picture in_unit(Picture picture, const LightUnit& unit);

}  // namespace exitance
