#pragma once

#include <string>
#include <vector>

#include "exitance/measure/light_maps/curved_faces.hpp"

namespace exitance {

/// Reads the normals of a scene's glTF (NORMAL) or OBJ file (vn), for its triangles in the scene's axes. Normals point
/// to the fronts of the faces: those of a face that was turned when it was read, or whose normals are opposed to its
/// order of corners, are reversed. The back of a double-sided glTF face has the reversed normals of its front.
/// Triangles without normals are missing. Empty if the file does not exist, has another format or was changed after the
/// solve. O(n log n).
/// path  path of the file, see find_scene_file()
std::vector<NormalTriangle> load_normals(const Scene& scene, const std::string& path);

}  // namespace exitance
