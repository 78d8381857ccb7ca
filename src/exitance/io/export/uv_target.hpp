#pragma once

#include <optional>
#include <span>
#include <string>

#include "exitance/io/export/light_map_files.hpp"
#include "exitance/measure/light_maps/unwrap.hpp"

namespace exitance {

/// Texture coordinates into which light is baked.
struct UvTarget {
    UvSet set;
    std::optional<Unwrapped> unwrapped;  ///< Coordinates that were made; none: those of the scene's file.
    UvBakeOptions options;               ///< Bake options, with the size of the map if coordinates were made.
};

/// Reads texture coordinates from the scene's file, or makes them.
/// scene_file  path of the file, see find_scene_file()
/// name        a set as for load_uv_set(), or "unwrap"
/// Errors: those of load_uv_set() and unwrap().
Result<UvTarget> find_uv_target(const Scene& scene, const std::string& scene_file, const std::string& name,
                                const UvBakeOptions& options);

/// Writes lightmaps.json and, if coordinates were made, the model that has them.
/// format  with the path of the scene's file
/// charts  file names of pictures of the charts, one per map, or empty
Result<void> write_uv_model(const Solution& solution, const UvTarget& target, const UvLightMaps& maps,
                            const LightMapFormat& format, std::span<const std::string> groups,
                            std::span<const std::string> charts, const std::string& folder);

}  // namespace exitance
