#pragma once

#include "exitance/cli/arguments.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {

/// Error (usage) if --light-groups is set and the scene has more than `most_light_groups` groups that emit.
Result<void> check_light_groups(const SolveArguments& arguments, const Scene& scene);

/// The error for a solution without light groups, of a verb that needs them.
Error no_light_groups(const std::string& solution_file);

/// Solves the light groups for --light-groups and records their size and time in the statistics of the solution.
/// Returns no groups without --light-groups, or if a stop was requested first; a warning is then recorded.
Result<LightGroups> keep_light_groups(const SolveArguments& arguments, Solution& solution, Progress& progress,
                                      const StopRequest& stop);

}  // namespace exitance
