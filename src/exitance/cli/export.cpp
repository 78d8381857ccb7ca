#include "exitance/io/export.hpp"

#include "exitance/cli/verbs.hpp"
#include "exitance/io/solution_file.hpp"

namespace exitance {

/// exitance export SOLUTION -o FILE
ExitCode run(const ExportArguments& arguments, Terminal& terminal) {
    const Result<Solution> solution = load_solution(arguments.solution);
    if (!solution) return terminal.fail(solution.error());
    const Result<void> written = export_solution(*solution, arguments.output);
    return written ? ExitCode::done : terminal.fail(written.error());
}

}  // namespace exitance
