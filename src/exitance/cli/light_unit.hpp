#pragma once

#include "exitance/cli/arguments.hpp"
#include "exitance/cli/terminal.hpp"

namespace exitance {

/// The unit that a user wants a scene's light in; notes where an efficacy given has no part in it.
LightUnit unit_of(const UnitArguments& arguments, const Scene& scene, Terminal& terminal);

}  // namespace exitance
