#pragma once

#include <string>

#include "exitance/io/photometry/photometry.hpp"
#include "exitance/scene/luminaire.hpp"

namespace exitance {

/// Draws the intensity in the planes C0-C180 (solid) and C90-C270 (dashed) as a polar diagram, with down at the bottom.
/// Circles are at round steps of cd (cd per 1000 lm of the lamps, if known). Returns an SVG file.
std::string polar_diagram(const Photometry& photometry);

/// Draws only the curves, the circles, and the value of the outermost circle: a small picture for a table (SVG).
std::string small_polar_diagram(const IntensityCurves& curves);

}  // namespace exitance
