#pragma once

#include <optional>
#include <string>

#include "exitance/cli/arguments.hpp"
#include "exitance/cli/exit_code.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// Where several processes work together, what does not run over them is an error that names what does.
Result<void> check_processes(const SolveArguments& arguments);

/// The scene, which the first process reads and checks, for all.
LoadedScene load_for_all(const SceneArguments& scene);

/// The exit status for a signal that any of the processes has received.
std::optional<ExitCode> signal_of_any(std::optional<ExitCode> own);

/// How many processes there were, what they sent, and what memory they took: all of them, and the one with the most.
void record_processes(SolveStatistics& statistics);

/// Processor time so far: of all processes on what was dealt out, and of the first one on everything else, which all
/// repeat or wait for.
void record_processor_time(SolveStatistics& statistics);

}  // namespace exitance
