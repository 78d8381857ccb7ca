#pragma once

#include "exitance/cli/options/arguments.hpp"
#include "exitance/cli/terminal.hpp"

namespace exitance {

/// Returns the unit in which a verb reports the scene's light. Prints a note if a given efficacy has no effect.
LightUnit unit_of(const UnitArguments& arguments, const Scene& scene, Terminal& terminal);

}  // namespace exitance
