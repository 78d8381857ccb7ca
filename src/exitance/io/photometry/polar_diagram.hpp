#pragma once

#include <string>

#include "exitance/io/photometry/photometry.hpp"

namespace exitance {

/// The intensity in the planes C0-C180 (solid) and C90-C270 (dashed) about the axis, as lighting designers draw it:
/// down is down, circles in round steps of cd (cd per 1000 lm of the lamps where these are known). A whole SVG file.
std::string polar_diagram(const Photometry& photometry);

}  // namespace exitance
