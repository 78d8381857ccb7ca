#pragma once

#include <string>

#include "exitance/measure/pictures/picture.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {

/// Encodes a picture for the viewer's page, which applies the tone map: the letters EXF1, width and height (uint32);
/// then for each pixel, with rows from bottom to top, radiosity (3 float32, W/m^2) and the share of the pixel that
/// shows fronts; then for each pixel irradiance (one number in the scene's unit, lx or W/m^2) and the share that shows
/// backs.
std::string viewer_frame(const Picture& picture, const LightUnit& own);

}  // namespace exitance
