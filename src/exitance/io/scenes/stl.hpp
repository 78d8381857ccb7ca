#pragma once

#include <string>

#include "exitance/io/scenes/obj/obj.hpp"

namespace exitance {

/// Reads an STL file, ASCII or binary as detected from its content. Triangles are counter-clockwise seen from their
/// front; stored normals are ignored. Each solid becomes a group. All faces have one grey material of reflectance 0.5.
/// Lengths are in metres. O(size).
ReadScene read_stl(const std::string& path);

}  // namespace exitance
