#include "exitance/load.hpp"

#include "exitance/api/inside.hpp"
#include "exitance/api/sky.hpp"

namespace exitance::api {
namespace {

Result<Scene> load_files(std::span<const std::string> files, const LoadOptions& options, Run& run) {
    if (files.empty()) return usage("there is no file", "load");
    if (options.length_unit && !(*options.length_unit > 0))
        return usage("must be above 0", "length_unit", "metres per unit of the file");
    Result<std::optional<ChosenSky>> sky = read_sky(options.sky, options.epw);
    if (!sky) return sky.error();
    std::vector<std::string> warnings;
    if (*sky) {
        if (options.photometric) (*sky)->photometric = options.photometric;
        warnings = (*sky)->warnings;
    }
    exitance::LoadOptions in;
    in.faults = options.strict ? Faults::refuse : Faults::repair;
    in.stop = &run.stop();
    in.sky = std::move(*sky);
    in.luminaires = options.luminaires;
    in.light_groups = options.light_groups;
    in.photometric = options.photometric;
    in.turn_bodies = options.turn_bodies;
    in.metres_per_unit = options.length_unit;
    in.y_is_up = options.y_is_up;
    in.lod = options.lod;
    in.texture_parts = options.texture_parts;
    LoadedScene loaded = load_scene(files, in);
    if (!loaded.scene) return to_api(loaded.scene.error());
    if (options.photometric) loaded.scene->declare_photometric(*options.photometric);
    SceneData data{std::make_shared<const exitance::Scene>(std::move(*loaded.scene)),
                   {},
                   loaded.findings,
                   loaded.reflectance_deviation,
                   options.light_groups,
                   std::vector<std::string>(files.begin(), files.end()),
                   in,
                   std::move(loaded.panes)};
    data.load.stop = nullptr;  // the request does not outlive this call
    for (const std::string& warning : warnings) data.findings.push_back({Finding::Kind::warning, "", warning, ""});
    for (const exitance::Finding& finding : loaded.findings) data.findings.push_back(to_api(finding));
    return Scene(std::make_shared<const SceneData>(std::move(data)));
}

}  // namespace

Result<Scene> load(std::span<const std::string> files, const LoadOptions& options, const Control& control) {
    return take_turn<Scene>(control, [&](Run& run) { return load_files(files, options, run); });
}

Result<Scene> load(const std::string& file, const LoadOptions& options, const Control& control) {
    return load(std::span(&file, 1), options, control);
}

}  // namespace exitance::api
