#include "exitance/base/parallel.hpp"
#include "exitance/cli/summary.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/io/solution/statistics_json.hpp"

namespace exitance {

/// Runs `exitance stats SOLUTION`.
ExitCode run(const StatsArguments& arguments, Terminal& terminal) {
    set_threads(arguments.threads);
    const Result<Solution> solution = load_solution(arguments.solution);
    if (!solution) return terminal.fail(solution.error());
    terminal.print(arguments.json ? statistics_json(*solution) : summary(*solution));
    return ExitCode::done;
}

}  // namespace exitance
