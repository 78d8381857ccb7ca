#include "exitance/io/export/export.hpp"

#include "exitance/base/parallel.hpp"
#include "exitance/cli/named_files.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/io/export/export_links.hpp"
#include "exitance/io/scenes/textures/scene_textures.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/methods/light/mesh_of_layers.hpp"

namespace exitance {

/// Runs `exitance export SOLUTION -o FILE`.
ExitCode run(const ExportArguments& arguments, Terminal& terminal) {
    set_threads(arguments.threads);
    Result<Solution> solution = load_solution(arguments.solution);
    if (!solution) return terminal.fail(solution.error());
    if (arguments.links.empty())
        if (const Result<void> made = make_requested_mesh(*solution); !made) return terminal.fail(made.error());
    const std::string scene_file = find_scene_file(solution->scene, arguments.solution);
    if (const Result<void> kept = check_scene_is_kept(arguments.output, scene_file); !kept)
        return terminal.fail(kept.error());
    const Result<void> written = arguments.links.empty() ? export_solution(*solution, arguments.output)
                                                         : export_links(*solution, arguments.links, arguments.output);
    if (!written) return terminal.fail(written.error());
    return ExitCode::done;
}

}  // namespace exitance
