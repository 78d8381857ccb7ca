#pragma once

#include "exitance/lab/tasks/task_options.hpp"
#include "exitance/methods/method_entry.hpp"

namespace exitance {

/// The method of `--method hierarchical --task-engine`: the light found by a TaskEngine, constant on its leaves. Links
/// transport the light of emitters as well.
GlobalLight solve_by_tasks(const MethodInput& input);

/// Returns the engine's settings: those requested, otherwise relative to the scene's area and to the flux emitted in
/// the brightest band.
TaskOptions task_options(const Scene& scene, const SolveOptions& options);

}  // namespace exitance
