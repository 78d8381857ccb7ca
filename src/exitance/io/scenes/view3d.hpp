#pragma once

#include <string>

#include "exitance/io/scenes/obj/obj.hpp"

namespace exitance {

/// Group of faces that block light but are not part of View3D's result.
inline constexpr const char* view3d_obstructions = "(obstructions)";

/// Reads an input file of NIST's View3D (.vs3) with geometry `F 3` (vertices and surfaces) or `F 3a` (planes). Each row
/// of View3D's result becomes a group, in View3D's order, named as the surface or by its number; pieces that `cmb`
/// merges are faces of one group. Subsurfaces (`base`) and null surfaces are cut out of their base. Reflectance is 1 -
/// emittance; nothing emits. Obstructions block light from both sides. O(size of the file).
/// Errors: input that View3D rejects (vertices or surfaces out of order, concave quadrangles, chains of `cmb`), and
/// mask surfaces.
ReadScene read_view3d(const std::string& path);

}  // namespace exitance
