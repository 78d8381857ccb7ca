#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "exitance/base/vec.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// A triangle of a face, with texture coordinates that are linear on it.
struct UvTriangle {
    SurfaceId surface;
    std::uint32_t object = 0;     ///< Index into UvSet::objects.
    std::array<Point, 3> corner;  ///< Counter-clockwise seen from the front of the face, metres.
    std::array<Vec2, 3> place;    ///< Texture coordinates: (0, 0) is the upper left of a map, (1, 1) the lower right.
};

/// One set of texture coordinates of a scene's file.
struct UvSet {
    std::string file;                  ///< Path of the file.
    std::string name;                  ///< Name of the set, such as TEXCOORD_1; "vt" in OBJ files.
    std::vector<std::string> objects;  ///< Names of glTF nodes or OBJ groups; all differ.
    std::vector<UvTriangle> triangles;
    std::size_t back_faces = 0;  ///< Number of faces that are the backs of double-sided ones and have no coordinates.
};

}  // namespace exitance
