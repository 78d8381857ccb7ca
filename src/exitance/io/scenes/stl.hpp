#pragma once

#include <string>

#include "exitance/io/scenes/obj/obj.hpp"

namespace exitance {

/// Reads an STL file, ASCII or binary as its content says: triangles, counter-clockwise seen from their front; stored
/// normals are ignored. A group a solid. One grey material, reflectance 0.5. Lengths are taken as metres. O(size).
ReadScene read_stl(const std::string& path);

}  // namespace exitance
