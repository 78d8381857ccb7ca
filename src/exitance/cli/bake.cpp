#include <fmt/format.h>

#include "exitance/cli/verbs.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/io/export/light_map_files.hpp"
#include "exitance/io/solution/solution_file.hpp"

namespace exitance {

/// exitance bake SOLUTION -o FOLDER
ExitCode run(const BakeArguments& arguments, Terminal& terminal) {
    const StopRequest stop;  // signals end the program at once: nothing is written before all is there
    set_threads(arguments.threads);
    const Result<Solution> solution = load_solution(arguments.solution);
    if (!solution) return terminal.fail(solution.error());
    const RadiosityFunction light(*solution);
    const Stopwatch watch;
    BakeOptions options;
    options.density = arguments.density, options.padding = static_cast<int>(arguments.padding);
    const Result<LightMaps> maps = bake_light_maps(light, options, terminal.progress(), stop);
    terminal.progress().finish();
    if (!maps) return terminal.fail(maps.error());
    const Result<void> written = write_light_maps(*solution, *maps, arguments.format, arguments.output);
    if (!written) return terminal.fail(written.error());
    std::string sizes;
    for (const LightMap& map : maps->maps)
        sizes += fmt::format("{}{} x {}", sizes.empty() ? "" : ", ", map.size.width, map.size.height);
    terminal.note(fmt::format("{} texels on surfaces at {} per metre, in {} {} ({}); {:.1f} s", maps->texels,
                              maps->density, maps->maps.size(), maps->maps.size() == 1 ? "map" : "maps", sizes,
                              watch.seconds()));
    return ExitCode::done;
}

}  // namespace exitance
