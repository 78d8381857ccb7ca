#include <fmt/format.h>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/solve/kept_groups.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/io/export/light_map_files.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/textures/scene_textures.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {
namespace {

/// Bakes and writes separate maps for every light group. Returns the names of the groups that were finished before a
/// stop was requested.
Result<std::vector<std::string>> bake_groups(const BakeArguments& arguments, const Solution& whole,
                                             const LightGroups& groups, const BakeOptions& options, Progress& progress,
                                             const StopRequest& stop) {
    std::vector<std::string> names;
    for (const LightGroup& group : groups.groups) {
        if (stop.requested()) break;
        Solution solution = whole;
        LightGroups dimmed = groups;
        LightChange change;
        for (const LightGroup& other : groups.groups)
            change.dim.emplace_back(other.emitters.name, &other == &group ? 1 : 0);
        if (const Result<void> changed = change_light(solution, dimmed, change); !changed) return changed.error();
        progress.phase("group " + group.emitters.name);
        const Result<LightMaps> maps = bake_light_maps(RadiosityFunction(solution), options, progress, stop);
        if (!maps) return maps.error();
        if (stop.requested()) break;
        const Result<void> written =
            write_group_light_maps(solution.scene, *maps, names.size(), arguments.format, arguments.output);
        if (!written) return written.error();
        names.push_back(group.emitters.name);
    }
    return names;
}

}  // namespace

/// Runs `exitance bake SOLUTION -o FOLDER`.
ExitCode run(const BakeArguments& arguments, Terminal& terminal) {
    set_threads(arguments.threads);
    LightGroups groups;
    const Result<Solution> solution =
        load_solution(arguments.solution, Rehearsed::not_yet, arguments.light_groups ? &groups : nullptr);
    if (!solution) return terminal.fail(solution.error());
    if (arguments.light_groups && groups.empty()) return terminal.fail(no_light_groups(arguments.solution));
    const RadiosityFunction light(*solution);
    const Stopwatch watch;
    BakeOptions options;
    options.density = arguments.density, options.padding = static_cast<int>(arguments.padding);
    RunLimits& limits = terminal.limits();
    const StopRequest& stop = limits.keep();
    const Result<LightMaps> maps = bake_light_maps(light, options, terminal.progress(), stop);
    if (!maps) return terminal.fail(maps.error());
    if (stop.requested()) return terminal.fail_stopped("the light maps are not finished");
    options.density = maps->density;  // so that all groups have the same charts
    const Result<std::vector<std::string>> names =
        bake_groups(arguments, *solution, groups, options, terminal.progress(), stop);
    terminal.progress().finish();
    if (!names) return terminal.fail(names.error());
    LightMapFormat format = arguments.format;
    const std::string scene_file = solution->scene.file();
    format.scene_file = find_scene_file(solution->scene, arguments.solution);
    if (format.scene_file.empty() && (ending(scene_file) == ".glb" || ending(scene_file) == ".gltf"))
        terminal.note(fmt::format("{} is missing: scene.glb has no textures", scene_file));
    const Result<void> written = write_light_maps(*solution, *maps, format, *names, arguments.output);
    if (!written) return terminal.fail(written.error());
    std::string sizes;
    for (const LightMap& map : maps->maps)
        sizes += fmt::format("{}{} x {}", sizes.empty() ? "" : ", ", map.size.width, map.size.height);
    terminal.note(fmt::format("{} texels on surfaces at {} per metre, in {} {} ({}); {:.1f} s", maps->texels,
                              maps->density, maps->maps.size(), maps->maps.size() == 1 ? "map" : "maps", sizes,
                              watch.seconds()));
    if (names->size() == groups.groups.size()) return ExitCode::done;
    terminal.note(fmt::format("stopped by the {}: {} of {} light groups have maps of their own", limits.reason(),
                              names->size(), groups.groups.size()));
    return limits.stopped_code();
}

}  // namespace exitance
