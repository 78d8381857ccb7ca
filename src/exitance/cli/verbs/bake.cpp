#include <fmt/format.h>

#include <functional>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/common_stop.hpp"
#include "exitance/cli/named_files.hpp"
#include "exitance/cli/solve/kept_groups.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/io/export/light_map_files.hpp"
#include "exitance/io/export/uv_map_files.hpp"
#include "exitance/io/export/uv_target.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/textures/normal_file.hpp"
#include "exitance/io/scenes/textures/scene_textures.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/methods/light/mesh_of_layers.hpp"
#include "exitance/processes/result_of_all.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {
namespace {

/// Bakes and writes the light of one group, given its number and the solution with that light alone. Returns false if a
/// stop was requested.
using BakeGroup = std::function<Result<bool>(const Solution& lit_by_group, std::size_t group)>;

/// Bakes and writes separate maps for every light group. Returns the names of the groups that were finished before a
/// stop was requested.
Result<std::vector<std::string>> bake_groups(const Solution& whole, const LightGroups& groups, Progress& progress,
                                             const StopRequest& stop, const BakeGroup& bake) {
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
        const Result<bool> finished = bake(solution, names.size());
        if (!finished) return finished.error();
        if (!*finished) break;
        names.push_back(group.emitters.name);
    }
    return names;
}

/// Writes the maps of a light group in the first process. Returns false if they are not finished.
template <class Maps, class Write>
Result<bool> write_group(const Result<Maps>& maps, const StopRequest& stop, const Write& write) {
    if (!maps) return maps.error();
    if (stop.requested()) return false;
    const Result<void> written = by_first(write);
    return written ? Result<bool>(true) : written.error();
}

/// Notes a stop before all groups were finished. Returns the program's exit code.
ExitCode end_of_groups(const LightGroups& groups, const std::vector<std::string>& names, const CommonStop& stop,
                       Terminal& terminal) {
    if (names.size() == groups.groups.size()) return ExitCode::done;
    terminal.note(fmt::format("stopped by the {}: {} of {} light groups have maps of their own", name_of(stop.reason()),
                              names.size(), groups.groups.size()));
    return stop.stopped_code();
}

template <class Maps, class Size>
std::string sizes_of(const Maps& maps, const Size& size_of) {
    std::string sizes;
    for (const auto& map : maps)
        sizes += fmt::format("{}{} x {}", sizes.empty() ? "" : ", ", size_of(map).width, size_of(map).height);
    return sizes;
}

/// Writes a picture of the charts of every map: FILE.png, or FILE_0.png and so on for several maps. Returns their
/// names.
Result<std::vector<std::string>> write_charts(const std::string& file, const UvSet& set, const UvLightMaps& maps) {
    std::vector<std::string> names;
    if (file.empty()) return names;
    const std::string stem = ending(file) == ".png" ? file.substr(0, file.size() - ending(file).size()) : file;
    for (std::size_t m = 0; m < maps.maps.size(); ++m) {
        names.push_back(maps.maps.size() == 1 ? stem + ".png" : fmt::format("{}_{}.png", stem, m));
        const ImageTexts texts{{"Software", "exitance"}};
        if (const Result<void> written = write_png(names.back(), draw_charts(set, maps, m), texts); !written)
            return written.error();
    }
    return names;
}

/// Reads the normals of the scene's file, unless light is to show the flat faces.
CurvedFaces find_curved_faces(const BakeArguments& arguments, const Scene& scene) {
    if (arguments.faceted) return {};
    return CurvedFaces(scene, load_normals(scene, find_scene_file(scene, arguments.solution)));
}

/// Notes how many regions are curved.
void note_curved(const CurvedDifferences& curved, Terminal& terminal) {
    if (curved.empty()) return;
    terminal.note(
        fmt::format("light follows the file's normals on {} flat parts of curved surfaces; it differs from the "
                    "solution's by {:.2g}% RMS",
                    curved.regions.size(), 100 * curved.rms()));
}

/// Error if the model in the folder would replace the scene's file.
Result<void> check_model(const BakeArguments& arguments, const Scene& scene) {
    const std::string scene_file = find_scene_file(scene, arguments.solution);
    const bool unwraps = arguments.uv == "unwrap";
    if (unwraps || arguments.uv.empty())
        if (const Result<void> kept = check_scene_is_kept(arguments.output + "/scene.glb", scene_file); !kept)
            return kept;
    return unwraps ? check_scene_is_kept(arguments.output + "/scene.obj", scene_file) : Result<void>();
}

/// Reads texture coordinates from the scene's file, or makes them.
Result<UvTarget> find_uv_target(const BakeArguments& arguments, const Scene& scene, const std::string& scene_file) {
    if (arguments.uv != "unwrap" && arguments.format.material != LightMapMaterial::emissive)
        return Error{ErrorCode::usage, "--unlit and --moz-lightmap need a scene.glb, which is written without --uv",
                     "--uv", "use --uv unwrap, or leave --uv out"};
    UvBakeOptions options;
    options.density = arguments.density, options.padding = static_cast<int>(arguments.padding);
    options.component = arguments.format.component, options.directions = arguments.format.directions;
    if (arguments.size) options.size = {arguments.size->width, arguments.size->height};
    return find_uv_target(scene, scene_file, arguments.uv, options);
}

/// Writes pictures of the charts, the model if its coordinates were made, and the manifest.
Result<void> write_uv_model(const BakeArguments& arguments, const Solution& solution, const UvTarget& target,
                            const std::string& scene_file, const UvLightMaps& maps,
                            std::span<const std::string> groups) {
    const Result<std::vector<std::string>> charts = write_charts(arguments.charts, target.set, maps);
    if (!charts) return charts.error();
    LightMapFormat format = arguments.format;
    format.scene_file = scene_file;
    return write_uv_model(solution, target, maps, format, groups, *charts, arguments.output);
}

/// Bakes into texture coordinates of the scene's file, or of its unwrapped faces.
ExitCode bake_into_uvs(const BakeArguments& arguments, const Solution& solution, const CurvedFaces& curved,
                       const LightGroups& groups, Terminal& terminal) {
    const std::string scene_file = find_scene_file(solution.scene, arguments.solution);
    const Stopwatch watch;
    Result<UvTarget> target = all_or_none(find_uv_target(arguments, solution.scene, scene_file));
    if (!target) return terminal.fail(target.error());
    const UvSet& set = target->set;
    UvBakeOptions& options = target->options;
    options.curved = &curved;
    auto& progress = terminal.progress();
    const CommonStop common(terminal, terminal.limits().keep());
    const StopRequest& stop = common.request();
    const Result<UvLightMaps> maps = bake_uv_light_maps(RadiosityFunction(solution), set, options, progress, stop);
    if (!maps) return terminal.fail(maps.error());
    if (stop.requested()) return common.fail("the light maps are not finished");
    const auto bake_group = [&](const Solution& lit, std::size_t group) -> Result<bool> {
        const Result<UvLightMaps> own = bake_uv_light_maps(RadiosityFunction(lit), set, options, progress, stop);
        return write_group(
            own, stop, [&] { return write_uv_pictures(lit.scene, *own, group, arguments.format, arguments.output); });
    };
    const Result<std::vector<std::string>> names = bake_groups(solution, groups, progress, stop, bake_group);
    progress.finish();
    if (!names) return terminal.fail(names.error());
    const Result<void> written = by_first([&] {
        const Result<void> pictures = write_uv_pictures(solution.scene, *maps, {}, arguments.format, arguments.output);
        return pictures ? write_uv_model(arguments, solution, *target, scene_file, *maps, *names) : pictures;
    });
    if (!written) return terminal.fail(written.error());
    note_curved(maps->curved, terminal);
    for (const std::string& warning : chart_warnings(set, *maps)) terminal.note("warning: " + warning);
    if (target->unwrapped)
        terminal.note(fmt::format("{} charts cover {:.0f}% of the map, at {:.4g} texels per metre",
                                  target->unwrapped->charts, 100 * target->unwrapped->filled,
                                  target->unwrapped->density));
    const std::string coordinates =
        target->unwrapped ? "charts made by bake" : fmt::format("{} of {}", set.name, set.file);
    terminal.note(fmt::format("{} texels on surfaces in {}, in {} {} ({}); {:.1f} s", maps->texels, coordinates,
                              maps->maps.size(), maps->maps.size() == 1 ? "map" : "maps",
                              sizes_of(maps->maps, [](const UvLightMap& map) { return map.light.size; }),
                              watch.seconds()));
    return end_of_groups(groups, *names, common, terminal);
}

}  // namespace

/// Runs `exitance bake SOLUTION -o FOLDER`.
ExitCode run(const BakeArguments& arguments, Terminal& terminal) {
    set_threads(arguments.threads);
    if (arguments.format.directions != Directions::none && arguments.format.quantity != LightMapQuantity::irradiance)
        return terminal.fail(Error{ErrorCode::usage, "directions are those of arriving light", "--directional",
                                   "use --quantity irradiance"});
    LightGroups groups;
    Result<Solution> solution =
        all_or_none(load_solution(arguments.solution, Rehearsed::not_yet, arguments.light_groups ? &groups : nullptr));
    if (!solution) return terminal.fail(solution.error());
    if (arguments.light_groups && groups.empty()) return terminal.fail(no_light_groups(arguments.solution));
    if (groups.empty())  // light maps of groups are those of elements
        if (const Result<void> made = make_requested_mesh(*solution); !made) return terminal.fail(made.error());
    if (const Result<void> kept = by_first([&] { return check_model(arguments, solution->scene); }); !kept)
        return terminal.fail(kept.error());
    const CurvedFaces curved = find_curved_faces(arguments, solution->scene);
    if (!arguments.uv.empty()) return bake_into_uvs(arguments, *solution, curved, groups, terminal);
    const RadiosityFunction light(*solution);
    const Stopwatch watch;
    BakeOptions options;
    options.density = arguments.density, options.padding = static_cast<int>(arguments.padding);
    options.curved = &curved, options.component = arguments.format.component;
    options.directions = arguments.format.directions;
    const CommonStop common(terminal, terminal.limits().keep());
    const StopRequest& stop = common.request();
    const Result<LightMaps> maps = bake_light_maps(light, options, terminal.progress(), stop);
    if (!maps) return terminal.fail(maps.error());
    if (stop.requested()) return common.fail("the light maps are not finished");
    options.density = maps->density;  // gives all groups the same charts
    const auto bake_group = [&](const Solution& lit, std::size_t group) -> Result<bool> {
        const Result<LightMaps> own = bake_light_maps(RadiosityFunction(lit), options, terminal.progress(), stop);
        return write_group(own, stop, [&] {
            return write_group_light_maps(lit.scene, *own, group, arguments.format, arguments.output);
        });
    };
    const Result<std::vector<std::string>> names =
        bake_groups(*solution, groups, terminal.progress(), stop, bake_group);
    terminal.progress().finish();
    if (!names) return terminal.fail(names.error());
    LightMapFormat format = arguments.format;
    const std::string scene_file = solution->scene.file();
    format.scene_file = find_scene_file(solution->scene, arguments.solution);
    if (format.scene_file.empty() && (ending(scene_file) == ".glb" || ending(scene_file) == ".gltf"))
        terminal.note(fmt::format("{} is missing: scene.glb has no textures", scene_file));
    const Result<void> written =
        by_first([&] { return write_light_maps(*solution, *maps, format, *names, arguments.output); });
    if (!written) return terminal.fail(written.error());
    note_curved(maps->curved, terminal);
    const std::string sizes = sizes_of(maps->maps, [](const LightMap& map) { return map.size; });
    terminal.note(fmt::format("{} texels on surfaces at {} per metre, in {} {} ({}); {:.1f} s", maps->texels,
                              maps->density, maps->maps.size(), maps->maps.size() == 1 ? "map" : "maps", sizes,
                              watch.seconds()));
    return end_of_groups(groups, *names, common, terminal);
}

}  // namespace exitance
