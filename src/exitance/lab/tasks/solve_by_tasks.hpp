#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/lab/tasks/task_options.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// `--method hierarchical --task-engine`: the light that a TaskEngine finds, constant on its leaves, as the solution.
/// The light of emitters goes through the links like all other, and nothing is gathered again or certified: there is no
/// error estimate. An Error where the scene has light that links between diffuse patches cannot carry.
Result<Solution> solve_by_tasks(const Scene& scene, const SolveOptions& options, Progress& progress,
                                const StopRequest& stop);

/// The engine's settings: as asked for, else relative to the scene's area and to what its brightest band emits.
TaskOptions task_options(const Scene& scene, const SolveOptions& options);

}  // namespace exitance
