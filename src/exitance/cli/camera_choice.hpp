#pragma once

#include <string>

#include "exitance/cli/arguments.hpp"

namespace exitance {

/// The camera asked for, with what was left open: one of the scene's by name or number, the one given, or one that
/// shows the scene well. An error of code `usage` where the scene has none of that name.
Result<Camera> choose_camera(const RenderArguments& arguments, const RadiosityFunction& light);

/// A camera as --camera takes it.
std::string describe(const Camera& camera);

}  // namespace exitance
