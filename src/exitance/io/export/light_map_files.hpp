#pragma once

#include <array>
#include <span>
#include <string>
#include <utility>

#include "exitance/io/pictures/linear_image.hpp"
#include "exitance/io/pictures/tone_map.hpp"
#include "exitance/measure/light_maps/light_map.hpp"

namespace exitance {

/// What a light map's texels hold: what arrives, or what leaves, B = M + rho E. W/m^2.
enum class LightMapQuantity : std::uint8_t { irradiance, radiosity };

constexpr std::array<std::pair<LightMapQuantity, std::string_view>, 2> light_map_quantity_names{
    {{LightMapQuantity::irradiance, "irradiance"}, {LightMapQuantity::radiosity, "radiosity"}}};

/// How the .glb shows its light (write_light_map_glb).
enum class LightMapMaterial : std::uint8_t {
    emissive,      ///< Light as emission of black surfaces.
    unlit,         ///< KHR_materials_unlit: a picture of the light as base colour.
    moz_lightmap,  ///< MOZ_lightmap beside a base colour.
};

struct LightMapFormat {
    LightMapQuantity quantity = LightMapQuantity::irradiance;
    Precision precision = Precision::single;
    LightMapMaterial material = LightMapMaterial::emissive;
    std::string scene_file;  ///< Where the scene's own textures are, if it is glTF; empty: nowhere.
};

/// Writes the maps of one light group alone, number `group`, which lie on the charts that all light has:
/// lightmap_N_G.exr and .png, its own exposure. Makes the folder where there is none.
Result<void> write_group_light_maps(const Scene& lit_by_group, const LightMaps& light, std::size_t group,
                                    const LightMapFormat& format, const std::string& folder);

/// Writes what a folder of light maps holds, and makes the folder where there is none:
/// lightmap_N.exr   the numbers: R, G, B in W/m^2; `coverage`: the share of a texel that lies on its surface
/// lightmap_N.png   the same for people, toned
/// scene.glb        the scene with second texture coordinates
/// lightmaps.json   which texels belong to which face, and the `groups` that were written; written last
/// Each file appears whole or not at all.
Result<void> write_light_maps(const Solution& solution, const LightMaps& light, const LightMapFormat& format,
                              std::span<const std::string> groups, const std::string& folder);

/// The value of a texel of a chart in a quantity, W/m^2.
Spectrum texel_value(const Scene& scene, const LightMap& map, const Chart& chart, std::size_t index,
                     LightMapQuantity quantity);

/// Calls visit(chart, index) for every texel of a map's charts, their padding included.
template <class Visit>
void for_each_texel(const LightMaps& light, std::size_t map, const Visit& visit) {
    for (const Chart& chart : light.charts) {
        if (chart.map != map) continue;
        for (int y = chart.room.y; y < chart.room.y + chart.room.height; ++y)
            for (int x = chart.room.x; x < chart.room.x + chart.room.width; ++x)
                visit(chart, light.maps[map].index(x, y));
    }
}

/// Binary glTF 2.0: a triangle mesh of the input's faces, Y up, metres. TEXCOORD_0 and 1: the scene's own texture
/// coordinates, as many as it has; without any, TEXCOORD_0 are places in the face's plane, metres. The next one: places
/// in the light maps. Colours are radiosity times `tone.scale`:
///  emissive      black surfaces that emit rho E (stored from 0 to a peak), lamps a constant. Nothing but the light
///  that
///                was computed is seen, whatever lights a viewer brings along;
///  unlit         the picture of B, toned by `tone`;
///  moz_lightmap  reflectance as base colour, E in the extension, pi times as strong since such light maps are divided
///                by pi again.
Result<void> write_light_map_glb(const Solution& solution, const LightMaps& light, const LightMapFormat& format,
                                 const ToneMap& tone, const std::string& path);

}  // namespace exitance
