#pragma once

#include <string>

#include "exitance/io/scenes/obj/obj.hpp"

namespace exitance {

/// Reads a city model in CityJSON 1.0 to 2.0: surfaces of all city objects, with holes, shells, solids and instances of
/// templates. Every object becomes a group; the semantic type of a surface ("RoofSurface"), or else the type of its
/// object, becomes the name of its material, of reflectance 0.5. Of several levels of detail an object's highest is
/// read. Lengths are in metres, Z is up. Coordinates above 10 km are moved: `ReadScene::origin` holds whole metres that
/// were subtracted from them. Points and lines are skipped. O(size).
/// lod  read only this level of detail, such as "1.3"; objects without it are left out, with a warning. Empty: the
/// highest
ReadScene read_cityjson(const std::string& path, const std::string& lod);

}  // namespace exitance
