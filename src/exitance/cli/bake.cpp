#include <fmt/format.h>

#include "exitance/cli/verbs.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/io/export/light_map_files.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/scene_textures.hpp"
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
    LightMapFormat format = arguments.format;
    const std::string scene_file = solution->scene.file();
    format.scene_file = find_scene_file(solution->scene, arguments.solution);
    if (format.scene_file.empty() && (ending(scene_file) == ".glb" || ending(scene_file) == ".gltf"))
        terminal.note(fmt::format("{} is not there: scene.glb goes without its textures", scene_file));
    const Result<void> written = write_light_maps(*solution, *maps, format, arguments.output);
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
