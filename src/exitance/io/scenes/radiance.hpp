#pragma once

#include <string>

#include "exitance/io/scenes/obj.hpp"

namespace exitance {

/// Reads a Radiance scene description (.rad): polygon, ring, sphere, bubble, cone, cup, cylinder and tube with plastic,
/// metal, trans, light, glow and illum, by their diffuse parts; `source` of a small angle as parallel light; aliases;
/// `!xform` of further files, done here; no other command is run. Metres. What reflects does so from both sides, what
/// emits from its front. What is left out is among the findings. O(size of the files, copies counted).
ReadScene read_radiance(const std::string& path);

}  // namespace exitance
