#pragma once

#include <optional>
#include <span>
#include <string>

#include "exitance/io/export/light_map_files.hpp"
#include "exitance/io/pictures/png.hpp"
#include "exitance/measure/light_maps/unwrap.hpp"
#include "exitance/measure/light_maps/uv_light_map.hpp"

namespace exitance {

/// Writes maps in the texture coordinates of a scene's file: lightmap_N.exr and .png, as write_light_maps does, or
/// lightmap_N_G.exr and .png of light group number `group`. Creates the folder if necessary.
Result<void> write_uv_pictures(const Scene& scene, const UvLightMaps& light, std::optional<std::size_t> group,
                               const LightMapFormat& format, const std::string& folder);

/// Writes lightmaps.json: the maps, their objects, and the faults of the objects' charts.
/// charts     file names of pictures of the charts, one per map, or empty
/// unwrapped  coordinates that were made for the maps; null: those of the file
Result<void> write_uv_manifest(const Scene& scene, const UvSet& set, const UvLightMaps& light,
                               const LightMapFormat& format, std::span<const std::string> groups,
                               std::span<const std::string> charts, const Unwrapped* unwrapped,
                               const std::string& folder);

/// Writes the model with the coordinates of its maps: scene.glb, as write_light_map_glb does, and scene.obj if the
/// scene's file is OBJ. Returns the name of the coordinates in scene.glb.
Result<std::string> write_unwrapped_model(const Solution& solution, const Unwrapped& unwrapped,
                                          const UvLightMaps& light, const LightMapFormat& format,
                                          const std::string& folder);

/// Draws the charts of a map: every chart in a colour of its own, mirrored ones in blue, texels of which several
/// triangles cover the same part in red, and the gutter in a darker colour.
Image draw_charts(const UvSet& set, const UvLightMaps& light, std::size_t map);

/// Sentences about charts that overlap, are outside of the map, mirrored, collapsed or too close to each other, by
/// object. Empty if there is nothing to report.
std::vector<std::string> chart_warnings(const UvSet& set, const UvLightMaps& light);

}  // namespace exitance
