#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/cli/arguments.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// Solves by a classical form, writes the snapshots asked for beside the output, and records the options in force.
Result<Solution> run_classical(const SolveArguments& arguments, const Scene& scene, Progress& progress,
                               const StopRequest& stop);

}  // namespace exitance
