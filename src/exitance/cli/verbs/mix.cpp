#include <fmt/format.h>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/json_output.hpp"
#include "exitance/cli/solve/kept_groups.hpp"
#include "exitance/cli/summary.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/evaluate/energy.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/transport/stage.hpp"
#include "exitance/what_if/light_groups/light_change_words.hpp"

namespace exitance {

/// Runs `exitance mix SOLUTION GROUP=FACTOR ... -o SOLUTION`.
ExitCode run(const MixArguments& arguments, Terminal& terminal) {
    set_threads(arguments.threads);
    const Stopwatch watch;
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
    solution->statistics.seconds["mix"] = watch.seconds();
    solution->statistics.energy = {};
    if (!solution->scene.has_light_from_outside()) {
        Stage stage(solution->scene);
        stage.rooms = find_light_rooms(stage, 1, StopRequest());
        solution->statistics.energy = energy_of_interpolant(*solution, stage);
    }
    if (const Result<void> written = write_solution(arguments.output, *solution, &groups); !written)
        return terminal.fail(written.error());
    if (arguments.json)
        terminal.print(statistics_json(*solution));
    else if (!arguments.quiet)
        terminal.print(summary(*solution));
    return ExitCode::done;
}

}  // namespace exitance
