#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/cli/arguments.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// Is what was asked for of a classical form all obeyed? Asked before the work.
Result<void> check_classical(const SolveArguments& arguments);

/// Solves by a classical form, writes the snapshots asked for beside the output, and records the options in force.
Result<Solution> run_classical(const SolveArguments& arguments, const Scene& scene, Progress& progress,
                               const StopRequest& stop);

}  // namespace exitance
