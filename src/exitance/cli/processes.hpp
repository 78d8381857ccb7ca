#pragma once

#include <optional>

#include "exitance/base/progress.hpp"
#include "exitance/cli/exit_code.hpp"
#include "exitance/cli/options/arguments.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// Error (usage) if there are several processes and the method or an option does not run over them. The hint names
/// methods that do.
Result<void> check_processes(const SolveArguments& arguments);

/// The scene, read and checked by the first process and sent to all others, without its findings and lines.
/// Collective.
LoadedScene load_for_all(const SceneArguments& scene);

/// The exit status for a signal that any of the processes has received, `own` being that of this process; none if there
/// was no signal. Collective.
std::optional<ExitCode> signal_of_any(std::optional<ExitCode> own);

/// Records the number of processes, their messages and times, and their peak memory: the sum, and the largest of a
/// process. Collective; does nothing with one process.
void record_processes(SolveStatistics& statistics);

/// Records processor time so far: that of all processes on distributed work, and that of the first process on all other
/// work, which the others repeat or wait for. Collective.
void record_processor_time(SolveStatistics& statistics);

/// Notes, with -v, how the work of a verb was divided, if there are several processes: processor time and memory.
/// Collective.
void note_division(Progress& progress);

}  // namespace exitance
