#pragma once

#include "exitance/measure/pictures/picture.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {

/// The same picture with light as one number in a unit, alike in all bands: every kind of mean shows that number.
Picture in_unit(Picture picture, const LightUnit& unit);

}  // namespace exitance
