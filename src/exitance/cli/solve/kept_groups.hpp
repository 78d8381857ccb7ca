#pragma once

#include "exitance/cli/arguments.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {

/// An error if the scene has more groups than are solved one by one. Called before the work.
Result<void> check_light_groups(const SolveArguments& arguments, const Scene& scene);

/// What is wrong with a solution that has none.
Error no_light_groups(const std::string& solution_file);

/// The light groups of a solution, where they are to be kept; its statistics tell their size and time. None, and a
/// warning, where a stop came first.
Result<LightGroups> keep_light_groups(const SolveArguments& arguments, Solution& solution, Progress& progress,
                                      const StopRequest& stop);

}  // namespace exitance
