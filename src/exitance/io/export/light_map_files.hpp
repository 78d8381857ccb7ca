#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "exitance/io/pictures/linear_image.hpp"
#include "exitance/io/pictures/png.hpp"
#include "exitance/io/pictures/tone_map.hpp"
#include "exitance/measure/light_maps/light_map.hpp"

namespace exitance {

/// Quantity in the texels of a light map: irradiance E, or radiosity B = M + rho E, W/m^2.
enum class LightMapQuantity : std::uint8_t { irradiance, radiosity };

constexpr std::array<std::pair<LightMapQuantity, std::string_view>, 2> light_map_quantity_names{
    {{LightMapQuantity::irradiance, "irradiance"}, {LightMapQuantity::radiosity, "radiosity"}}};

constexpr std::array<std::pair<Component, std::string_view>, 3> light_component_names{
    {{Component::total, "total"}, {Component::direct, "direct"}, {Component::indirect, "indirect"}}};

constexpr std::array<std::pair<Directions, std::string_view>, 3> direction_form_names{
    {{Directions::none, "none"}, {Directions::sh, "sh"}, {Directions::dominant, "dominant"}}};

/// Representation of light in the .glb (write_light_map_glb).
enum class LightMapMaterial : std::uint8_t {
    emissive,      ///< Light is the emission of black surfaces.
    unlit,         ///< KHR_materials_unlit: a picture of the light is the base colour.
    moz_lightmap,  ///< MOZ_lightmap in addition to a base colour.
};

struct LightMapFormat {
    LightMapQuantity quantity = LightMapQuantity::irradiance;
    Component component = Component::total;
    Precision precision = Precision::single;
    Directions directions = Directions::none;
    bool with_hdr = false;  ///< True if every map is also written as .hdr (write_hdr).
    LightMapMaterial material = LightMapMaterial::emissive;
    std::string scene_file;  ///< glTF file with the scene's own textures; empty: none.
};

/// File name without ending: lightmap_0, or lightmap_0_2 for light group 2 only.
std::string light_map_stem(std::size_t map, std::optional<std::size_t> group = {});
/// Formats the end of the list of maps in lightmaps.json and, if there are any, the light groups with the files of
/// each.
std::string groups_json(std::span<const std::string> groups, std::size_t maps, const LightMapFormat& format);
/// Formats the differences of curved regions from the solution, as a line of lightmaps.json; empty if there are none.
std::string curved_json(const CurvedDifferences& curved);
/// Unit of a quantity in a scene's maps.
const char* unit_of(const Scene& scene, LightMapQuantity quantity);
std::string_view name_of(LightMapQuantity quantity);
std::string_view name_of(Component component);
/// Names the values of maps: "irradiance", or "direct irradiance" for a part of the light.
std::string values_name(const LightMapFormat& format);
/// Writes the numbers of a map as STEM.exr, and as STEM.hdr if requested.
Result<void> write_map_numbers(const std::string& stem, const LinearImage& image, const Scene& scene,
                               const LightMapFormat& format);
/// Formats the file names of a map for lightmaps.json: `file`, `preview`, and `hdr` and `directional` if they are
/// written.
std::string map_files_json(std::size_t map, const LightMapFormat& format);
/// Creates a folder for maps if it does not exist.
Result<void> make_map_folder(const std::string& folder);

/// Writes the maps of one light group, number `group`, in the same charts as those of all light: lightmap_N_G.exr, and
/// .png with its own exposure. Creates the folder if necessary.
Result<void> write_group_light_maps(const Scene& lit_by_group, const LightMaps& light, std::size_t group,
                                    const LightMapFormat& format, const std::string& folder);

/// Writes all files of a folder of light maps, and creates the folder if necessary:
///
///     lightmap_N.exr   values: R, G, B in W/m^2; `coverage`: share of a texel that is on its surface
///     lightmap_N.hdr   R, G, B with a common exponent, if the format has it
///     lightmap_N.png   the same as a tone-mapped picture
///     lightmap_N_*     directions, if the format has them (write_directional)
///     scene.glb        the scene with texture coordinates for the maps
///     lightmaps.json   texels of each face, and the `groups` that were written; written last
///
/// Each file appears whole or not at all.
Result<void> write_light_maps(const Solution& solution, const LightMaps& light, const LightMapFormat& format,
                              std::span<const std::string> groups, const std::string& folder);

/// Returns a map's values as a tone-mapped picture.
Image map_picture(const Scene& scene, const LightMaps& light, std::size_t map, LightMapQuantity quantity,
                  const ToneMap& tones);

/// Value of a texel of a chart in the given quantity, W/m^2.
Spectrum texel_value(const Scene& scene, const LightMap& map, const Chart& chart, std::size_t index,
                     LightMapQuantity quantity);

/// Calls visit(chart, index) for every texel of a map's charts, including padding.
template <class Visit>
void for_each_texel(const LightMaps& light, std::size_t map, const Visit& visit) {
    for (const Chart& chart : light.charts) {
        if (chart.map != map) continue;
        for (int y = chart.room.y; y < chart.room.y + chart.room.height; ++y)
            for (int x = chart.room.x; x < chart.room.x + chart.room.width; ++x)
                visit(chart, light.maps[map].index(x, y));
    }
}

/// Writes binary glTF 2.0: a triangle mesh of the input faces, Y up, metres. The first texture coordinates are the
/// scene's own sets; if it has none, TEXCOORD_0 is the position in the face's plane, metres. The last set is the
/// position in the light maps. Colours are radiosity times `tone.scale`:
///
///     emissive      black surfaces emit rho E (stored from 0 to a peak), and lamps a constant; lights of a viewer add
///                   nothing
///     unlit         the picture of B, tone mapped by `tone`
///     moz_lightmap  the reflectance is the base colour, and E is in the extension, times pi, since viewers divide such
///                   light maps by pi
Result<void> write_light_map_glb(const Solution& solution, const LightMaps& light, const LightMapFormat& format,
                                 const ToneMap& tone, const std::string& path);

}  // namespace exitance
