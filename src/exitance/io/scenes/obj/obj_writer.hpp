#pragma once

#include <string>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Writes a scene as OBJ, with an MTL file of the same name beside it; all numbers come back as they were, emission but
/// for rounding. Both files appear whole or not at all. Error: cannot_write.
Result<void> write_obj(const SceneDescription& scene, const std::string& path);

}  // namespace exitance
