#pragma once

#include <string>
#include <string_view>

#include "exitance/base/spectrum.hpp"

namespace exitance {

/// Returns the name of a material for the faces of a textured one that share a colour: "bricks #a0522d".
std::string name_with_colour(std::string_view material, const Spectrum& colour);

/// Returns the name in the file, without such a colour.
std::string_view name_in_file(std::string_view material);

/// Returns the sRGB code of a linear value: 0 to 255 for 0 to 1.
int srgb_code(double linear);

}  // namespace exitance
