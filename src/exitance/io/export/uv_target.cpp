#include "exitance/io/export/uv_target.hpp"

#include "exitance/io/export/uv_map_files.hpp"
#include "exitance/io/scenes/textures/uv_file.hpp"

namespace exitance {

Result<UvTarget> find_uv_target(const Scene& scene, const std::string& scene_file, const std::string& name,
                                const UvBakeOptions& options) {
    UvTarget out;
    out.options = options;
    if (name != "unwrap") {
        Result<UvSet> set = load_uv_set(scene, scene_file, name);
        if (!set) return set.error();
        out.set = std::move(*set);
        return out;
    }
    Result<Unwrapped> made =
        unwrap(scene, {.size = options.size, .density = options.density, .padding = options.padding});
    if (!made) return made.error();
    out.set = uv_set_of(scene, *made);
    out.options.size = made->size;
    out.unwrapped = std::move(*made);
    return out;
}

Result<void> write_uv_model(const Solution& solution, const UvTarget& target, const UvLightMaps& maps,
                            const LightMapFormat& format, std::span<const std::string> groups,
                            std::span<const std::string> charts, const std::string& folder) {
    const Unwrapped* unwrapped = target.unwrapped ? &*target.unwrapped : nullptr;
    UvSet set = target.set;
    if (unwrapped) {
        const Result<std::string> name = write_unwrapped_model(solution, *unwrapped, maps, format, folder);
        if (!name) return name.error();
        set.file = "scene.glb", set.name = *name;
    }
    return write_uv_manifest(solution.scene, set, maps, format, groups, charts, unwrapped, folder);
}

}  // namespace exitance
