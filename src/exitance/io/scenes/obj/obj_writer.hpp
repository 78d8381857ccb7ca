#pragma once

#include <string>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Writes a scene as OBJ, with an MTL file of the same name in the same folder. Reading restores all numbers exactly,
/// except emission, which is rounded. Each file appears whole or not at all. Error: cannot_write.
Result<void> write_obj(const SceneDescription& scene, const std::string& path);

}  // namespace exitance
