#pragma once

#include <string>
#include <string_view>

#include "exitance/base/spectrum.hpp"

namespace exitance {

/// The name of a material that some faces of a textured one share: "bricks #a0522d".
/// colour  linear, in [0, 1]
std::string name_with_colour(std::string_view material, const Spectrum& colour);

/// The name that a file has, without such a colour.
std::string_view name_in_file(std::string_view material);

/// The code of a linear value in sRGB's curve, 255 for 1.
int srgb_code(double linear);

}  // namespace exitance
