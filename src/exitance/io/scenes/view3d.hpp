#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exitance/io/scenes/obj/obj.hpp"

namespace exitance {

/// Group of faces that block light but are not part of View3D's result.
inline constexpr const char* view3d_obstructions = "(obstructions)";

/// Reads an input file of NIST's View3D (.vs3) with geometry `F 3` (vertices and surfaces) or `F 3a` (planes). Each row
/// of View3D's result becomes a group, in View3D's order, named as the surface or by its number; pieces that `cmb`
/// merges are faces of one group. Subsurfaces (`base`) and null surfaces are cut out of their base. Reflectance is 1 -
/// emittance; nothing emits. Obstructions block light from both sides. Masks are cut out of their base, too, and are
/// faces of their own, whose backs hide what is behind (see View3dMask). O(size of the file).
/// Errors: input that View3D rejects (vertices or surfaces out of order, concave quadrangles, chains of `cmb`, masks
/// without a base or that face like it).
ReadScene read_view3d(const std::string& path);

/// A mask surface: it lies on a part of its base and faces it, so that this part exchanges heat with the mask only.
struct View3dMask {
    std::uint32_t row, base;  ///< Rows of the mask and of its base in View3D's result, from 0.
};

/// Returns the masks of a file that read_view3d() reads without errors; none if it cannot be read.
std::vector<View3dMask> read_view3d_masks(const std::string& path);

}  // namespace exitance
