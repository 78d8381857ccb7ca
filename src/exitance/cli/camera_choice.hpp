#pragma once

#include <string>

#include "exitance/cli/options/arguments.hpp"

namespace exitance {

/// Returns the requested camera with default values filled in: a camera of the scene by its name or number, the given
/// camera, or an automatic camera. Error (usage): the scene has no camera with that name or number, or the given one
/// has a fault.
Result<Camera> choose_camera(const RenderArguments& arguments, const RadiosityFunction& light);

/// Text of a camera as a value of --camera.
std::string describe(const Camera& camera);

}  // namespace exitance
