#pragma once

#include <string>

#include "exitance/measure/light_maps/uv_set.hpp"

namespace exitance {

/// Reads a set of texture coordinates from a scene's file. The faces of the scene may have been repaired when they were
/// read: their triangles keep the coordinates of the file's face, and corners that a repair has added are interpolated.
/// The back of a double-sided face has no coordinates, since they would be those of its front.
/// path  path of the file, see find_scene_file()
/// name  TEXCOORD_0 to TEXCOORD_3 (glTF), vt (OBJ), or "own": the set that light maps use, which is TEXCOORD_1 of glTF
///       files that have it, else TEXCOORD_0, and vt of OBJ files
/// Errors: the file is missing, has another format or no such set (`usage`); some faces have no coordinates
/// (bad_input, with the names of their objects). O(n log n).
Result<UvSet> load_uv_set(const Scene& scene, const std::string& path, const std::string& name);

}  // namespace exitance
