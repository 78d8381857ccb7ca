#pragma once

#include <string>

#include "exitance/io/scenes/obj/obj.hpp"

namespace exitance {

/// Reads a PLY file: text, or binary of either byte order. Needs elements `vertex` with x, y and z, and `face` with a
/// list `vertex_indices` or `vertex_index`; skips all other elements and properties. Faces are counter-clockwise seen
/// from their front, and have one grey material of reflectance 0.5; colours are ignored with a warning. Lengths are in
/// metres. O(size).
ReadScene read_ply(const std::string& path);

}  // namespace exitance
