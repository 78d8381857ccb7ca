#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/cli/arguments.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// Solves by a published form. Writes the requested snapshots as STEM.0001.h5, ... for an output STEM.h5, and records
/// the options in the solution.
Result<Solution> run_classical(const SolveArguments& arguments, const Scene& scene, Progress& progress,
                               const StopRequest& stop);

}  // namespace exitance
