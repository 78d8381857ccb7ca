#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/lab/tasks/task_options.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// Solves for `--method hierarchical --task-engine`: the light found by a TaskEngine, constant on its leaves. Links
/// transport the light of emitters as well. Nothing is gathered or certified afterwards, so there is no error estimate.
/// Returns an Error if the scene has light that links between diffuse patches cannot transport.
Result<Solution> solve_by_tasks(const Scene& scene, const SolveOptions& options, Progress& progress,
                                const StopRequest& stop);

/// Returns the engine's settings: those requested, otherwise relative to the scene's area and to the flux emitted in
/// the brightest band.
TaskOptions task_options(const Scene& scene, const SolveOptions& options);

}  // namespace exitance
