#pragma once

#include <string>

#include "exitance/scene/photometric_units.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

// The names and the order of the keys are part of the program's interface. The text has no line end.

/// The statistics in a report page: `stats --json` without the keys that describe mesh, links and direct light. `own`:
/// unit of the scene's light.
std::string statistics_json(const SolveStatistics& statistics, const LightUnit& own);

/// `solve --json` and `stats --json`: statistics, and the kinds of mesh, links and direct light.
std::string statistics_json(const Solution& solution);

}  // namespace exitance
