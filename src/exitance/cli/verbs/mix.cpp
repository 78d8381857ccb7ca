#include "exitance/base/parallel.hpp"
#include "exitance/cli/named_files.hpp"
#include "exitance/cli/solve/kept_groups.hpp"
#include "exitance/cli/summary.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/io/solution/statistics_json.hpp"
#include "exitance/what_if/light_groups/keep_light_groups.hpp"
#include "exitance/what_if/light_groups/light_change_words.hpp"

namespace exitance {

/// Runs `exitance mix SOLUTION GROUP=FACTOR ... -o SOLUTION`.
ExitCode run(const MixArguments& arguments, Terminal& terminal) {
    set_threads(arguments.threads);
    const Stopwatch watch;
    if (const Result<void> name = check_solution_name("mix", arguments.output); !name)
        return terminal.fail(name.error());
    LightChange change;
    for (const std::string& word : arguments.dim)
        if (const Result<void> read = read_dim(word, change); !read) return terminal.fail(read.error());
    for (const std::string& word : arguments.reflectance)
        if (const Result<void> read = read_reflectance(word, change); !read) return terminal.fail(read.error());
    LightGroups groups;
    Result<Solution> solution = load_solution(arguments.solution, Rehearsed::not_yet, &groups);
    if (!solution) return terminal.fail(solution.error());
    if (groups.empty()) return terminal.fail(no_light_groups(arguments.solution));
    if (const Result<void> changed = change_light(*solution, groups, change); !changed)
        return terminal.fail(changed.error());
    solution->statistics.seconds[RunPart::mix] = watch.seconds();
    solution->statistics.energy = energy_after_change(*solution);
    if (const Result<void> written = write_solution(arguments.output, *solution, &groups); !written)
        return terminal.fail(written.error());
    if (arguments.json)
        terminal.print(statistics_json(*solution));
    else if (!arguments.quiet)
        terminal.print(summary(*solution));
    return ExitCode::done;
}

}  // namespace exitance
