#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/io/export/light_map_files.hpp"

namespace exitance {

/// File names of the directions of a map, without a folder: lightmap_0_sh0.exr to _sh3.exr, or lightmap_0_direction.exr
/// and .png; empty if the format has none.
std::vector<std::string> directional_files(std::size_t map, std::optional<std::size_t> group,
                                           const LightMapFormat& format);

/// Writes the directions of a map, if it has them:
///
///     _shN.exr        R, G, B: coefficient N of radiance in the order (0, 0), (1, -1), (1, 0), (1, 1), W/(m^2 sr)
///     _direction.exr  X, Y, Z as R, G, B: the dominant direction times the share of the light that has it
///     _direction.png  the same, from -1 to 1
Result<void> write_directional(const LightMap& light, std::size_t map, std::optional<std::size_t> group,
                               const Scene& scene, const LightMapFormat& format, const std::string& folder);

/// Formats the names of a map's files as the elements of an array in lightmaps.json; empty if there are none.
std::string directional_list(std::size_t map, std::optional<std::size_t> group, const LightMapFormat& format);
/// Formats the form of the directions as a line of lightmaps.json; empty if there are none.
std::string directional_json(const Scene& scene, const LightMapFormat& format);

}  // namespace exitance
