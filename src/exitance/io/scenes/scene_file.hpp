#pragma once

#include <string>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// What becomes of faces that are no polygons of a plane, as modelling programs write quads.
enum class BentFaces : std::uint8_t {
    refuse,  ///< They are errors.
    split,   ///< Into triangles, each a surface of its own, and said.
};

/// Reads and checks a scene file; its ending says what it is (.obj, .gltf, .glb, .rad). Every error of the file is
/// among the findings. An unreadable file has the code cannot_read, everything else that is wrong bad_input.
CheckedScene load_scene(const std::string& path, BentFaces bent = BentFaces::refuse);

/// What a scene file says, not yet checked; nothing, where it is of no known kind or cannot be read.
SceneDescription read_description(const std::string& path);

}  // namespace exitance
