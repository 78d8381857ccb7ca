#pragma once

#include <string>

#include "exitance/measure/pictures/picture.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {

/// A picture for the viewer's page, which tones it: the letters EXF1, width and height (uint32), then of every pixel,
/// rows from the bottom to the top as textures have them, radiosity (3 float32, W/m^2) and the share of the pixel that
/// shows fronts; then of every pixel irradiance (all bands as one number in the scene's unit, lx or W/m^2) and the
/// share that shows backs.
std::string viewer_frame(const Picture& picture, const LightUnit& own);

}  // namespace exitance
