#pragma once

#include <string>

#include "exitance/io/scenes/obj/obj.hpp"

namespace exitance {

/// The group of faces that block and are no part of a View3D file's result.
inline constexpr const char* view3d_obstructions = "(obstructions)";

/// Reads the input of NIST's View3D (.vs3), geometry `F 3` (vertices and surfaces) and `F 3a` (planes): a group for
/// each row of View3D's result, in its order and named as the surface, or by its number; pieces that `cmb` merges are
/// faces of one group. Subsurfaces (`base`) and null surfaces are cut out of their base. Reflectance is 1 - emit;
/// nothing emits. Obstructions block from both sides. Errors: what View3D refuses (vertices or surfaces out of order,
/// concave quadrangles, chains of `cmb`), and mask surfaces. O(size of the file).
ReadScene read_view3d(const std::string& path);

}  // namespace exitance
