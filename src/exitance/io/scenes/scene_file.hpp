#pragma once

#include <string>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// What becomes of faults that have a safe repair.
enum class Faults : std::uint8_t {
    repair,  ///< They are repaired, and said.
    refuse,  ///< They are errors.
};

/// Reads and checks a scene file; its ending says what it is (.obj, .gltf, .glb, .rad). Every error of the file is
/// among the findings. An unreadable file has the code cannot_read, everything else that is wrong bad_input.
CheckedScene load_scene(const std::string& path, Faults faults = Faults::repair);

/// What a scene file says, not yet checked; nothing, where it is of no known kind or cannot be read.
SceneDescription read_description(const std::string& path);

}  // namespace exitance
