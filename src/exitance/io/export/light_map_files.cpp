#include "exitance/io/export/light_map_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>

#include "exitance/base/version.hpp"
#include "exitance/base/words.hpp"
#include "exitance/io/export/directional_files.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/pictures/display.hpp"
#include "exitance/io/pictures/png.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {
namespace {

LinearImage map_numbers(const Scene& scene, const LightMaps& light, std::size_t m, LightMapQuantity quantity) {
    const LightMap& map = light.maps[m];
    LinearImage image{map.size.width, map.size.height, {}};
    for (const char* name : {"R", "G", "B"}) image.channels.push_back({name, std::vector<float>(map.size.texels())});
    for_each_texel(light, m, [&](const Chart& chart, std::size_t i) {
        const auto rgb = red_green_blue(texel_value(scene, map, chart, i, quantity));
        for (std::size_t c = 0; c < 3; ++c) image.channels[c].values[i] = static_cast<float>(rgb[c]);
    });
    image.channels.push_back({"coverage", map.share});
    return image;
}

/// Tone map that brings the maps, except lamps, to middle grey on average.
ToneMap preview_tones(const Scene& scene, const LightMaps& light, LightMapQuantity quantity) {
    double sum = 0, weight = 0;
    for (std::size_t m = 0; m < light.maps.size(); ++m)
        for_each_texel(light, m, [&](const Chart& chart, std::size_t i) {
            const auto share = static_cast<double>(light.maps[m].share[i]);
            if (share == 0 || scene.material(chart.region).emits()) return;
            const double value = mean(texel_value(scene, light.maps[m], chart, i, quantity));
            if (value > 0) sum += share * std::log(value), weight += share;
        });
    ToneMap tones;
    tones.curve = ToneCurve::filmic;
    tones.scale = weight > 0 ? 0.18 / std::exp(sum / weight) : 1;
    return tones;
}

std::string triple_of_metres(const Vec3& v) {
    return fmt::format("[{},{},{}]", v.x, v.y, v.z);
}

/// Formats the texels that a face touches, with their position in space.
/// curved  the difference of the face's region if it is curved; else null
std::string chart_json(const Scene& scene, SurfaceId s, const Chart& chart, const CurvedDifference* curved) {
    constexpr double rounding = 1e-6;
    Vec2 lo{HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL};
    for (const Point& p : scene.outline(s)) {
        const Vec2 place = chart.place(p);
        lo = {std::min(lo.x, place.x), std::min(lo.y, place.y)};
        hi = {std::max(hi.x, place.x), std::max(hi.y, place.y)};
    }
    const int x0 = std::clamp(static_cast<int>(std::floor(lo.x + rounding)), 0, chart.width - 1);
    const int y0 = std::clamp(static_cast<int>(std::floor(lo.y + rounding)), 0, chart.height - 1);
    const int x1 = std::clamp(static_cast<int>(std::ceil(hi.x - rounding)), x0 + 1, chart.width);
    const int y1 = std::clamp(static_cast<int>(std::ceil(hi.y - rounding)), y0 + 1, chart.height);
    return fmt::format(
        "    {{\"surface\": {}, \"map\": {}, \"x\": {}, \"y\": {}, \"width\": {}, \"height\": {}, \"origin\": {}, "
        "\"du\": {}, \"dv\": {}, \"normal\": {}{}}}",
        s.value, chart.map, chart.x + x0, chart.y + y0, x1 - x0, y1 - y0,
        triple_of_metres(chart.at({x0 + 0.5, y0 + 0.5})), triple_of_metres(chart.du), triple_of_metres(chart.dv),
        triple_of_metres(scene.surfaces()[s].normal),
        curved ? fmt::format(", \"curved_difference\": {:.6g}", curved->value()) : std::string());
}

std::string manifest(const Scene& scene, const LightMaps& light, const LightMapFormat& format, const ToneMap& tones,
                     std::span<const std::string> groups) {
    std::string text = fmt::format(
        "{{\n  \"version\": 1,\n  \"generator\": \"exitance {}\",\n  \"quantity\": \"{}\",\n  \"component\": \"{}\",\n"
        "  \"unit\": \"{}\",\n  \"texels_per_metre\": {},\n  \"padding\": {},\n  \"model\": \"scene.glb\",\n  "
        "\"exposure\": {},\n  "
        "\"maps\": [",
        program_version, name_of(format.quantity), name_of(format.component), unit_of(scene, format.quantity),
        light.density, light.padding, tones.scale);
    for (std::size_t m = 0; m < light.maps.size(); ++m)
        text += fmt::format("{}\n    {{{}, \"width\": {}, \"height\": {}}}", m > 0 ? "," : "",
                            map_files_json(m, format), light.maps[m].size.width, light.maps[m].size.height);
    text += groups_json(groups, light.maps.size(), format);
    text += "\n  ]," + directional_json(scene, format) + curved_json(light.curved) + "\n  \"charts\": [";
    Field<RegionId, const CurvedDifference*> curved(scene.regions().size());
    for (const CurvedDifference& d : light.curved.regions) curved[d.region] = &d;
    for (SurfaceId s : scene.surfaces().ids()) {
        const RegionId region = scene.surfaces()[s].region;
        text += (s.value > 0 ? ",\n" : "\n") + chart_json(scene, s, light.charts[region.value], curved[region]);
    }
    return text + "\n  ]\n}\n";
}

/// Writes every map as an .exr file and as a picture.
Result<void> write_pictures(const Scene& scene, const LightMaps& light, std::optional<std::size_t> group,
                            const LightMapFormat& format, const std::string& folder) {
    const ToneMap tones = preview_tones(scene, light, format.quantity);
    for (std::size_t m = 0; m < light.maps.size(); ++m) {
        const std::string stem = folder + "/" + light_map_stem(m, group);
        const LinearImage image = map_numbers(scene, light, m, format.quantity);
        if (const Result<void> written = write_map_numbers(stem, image, scene, format); !written) return written;
        const std::string exposure = fmt::format("{} in {} times {:.6g}, then a filmic curve", values_name(format),
                                                 unit_of(scene, format.quantity), tones.scale);
        const ImageTexts texts{{"Software", "exitance"}, {"Exposure", exposure}};
        const Result<void> written =
            write_png(stem + ".png", map_picture(scene, light, m, format.quantity, tones), texts);
        if (!written) return written;
        const Result<void> directed = write_directional(light.maps[m], m, group, scene, format, folder);
        if (!directed) return directed;
    }
    return {};
}

}  // namespace

std::string light_map_stem(std::size_t map, std::optional<std::size_t> group) {
    return group ? fmt::format("lightmap_{}_{}", map, *group) : fmt::format("lightmap_{}", map);
}

std::string groups_json(std::span<const std::string> groups, std::size_t maps, const LightMapFormat& format) {
    std::string text;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        text += g > 0 ? "," : "\n  ],\n  \"groups\": [";
        text += fmt::format("\n    {{\"name\": {}, \"files\": [", json_text(groups[g]));
        for (std::size_t m = 0; m < maps; ++m)
            text += fmt::format("{}\"{}.exr\"", m > 0 ? ", " : "", light_map_stem(m, g));
        text += "]";
        if (format.directions != Directions::none) {
            text += ", \"directional\": [";
            for (std::size_t m = 0; m < maps; ++m)
                text += fmt::format("{}[{}]", m > 0 ? ", " : "", directional_list(m, g, format));
            text += "]";
        }
        text += "}";
    }
    return text;
}

std::string curved_json(const CurvedDifferences& curved) {
    if (curved.empty()) return {};
    return fmt::format(
        "\n  \"curved\": {{\"regions\": {}, \"rms_difference\": {:.6g}, \"largest_difference\": {:.6g}}},",
        curved.regions.size(), curved.rms(), curved.largest());
}

std::string_view name_of(LightMapQuantity quantity) {
    return light_map_quantity_names[static_cast<std::size_t>(quantity)].second;
}

std::string_view name_of(Component component) {
    return light_component_names[static_cast<std::size_t>(component)].second;
}

std::string values_name(const LightMapFormat& format) {
    return format.component == Component::total
               ? std::string(name_of(format.quantity))
               : fmt::format("{} {}", name_of(format.component), name_of(format.quantity));
}

Result<void> write_map_numbers(const std::string& stem, const LinearImage& image, const Scene& scene,
                               const LightMapFormat& format) {
    const std::string units = fmt::format("R, G, B: {} in {}", values_name(format), unit_of(scene, format.quantity));
    const ImageFacts facts{{"software", "exitance"}, {"units", units}};
    const Result<void> written = write_exr(stem + ".exr", image, facts, format.precision);
    return written && format.with_hdr ? write_hdr(stem + ".hdr", image, facts) : written;
}

std::string map_files_json(std::size_t map, const LightMapFormat& format) {
    const std::string stem = light_map_stem(map);
    const std::string directed = directional_list(map, {}, format);
    return fmt::format("\"file\": \"{0}.exr\"{1}, \"preview\": \"{0}.png\"{2}", stem,
                       format.with_hdr ? fmt::format(", \"hdr\": \"{}.hdr\"", stem) : std::string(),
                       directed.empty() ? directed : fmt::format(", \"directional\": [{}]", directed));
}

const char* unit_of(const Scene& scene, LightMapQuantity quantity) {
    const LightUnit own = own_unit(scene.is_photometric());
    return quantity == LightMapQuantity::irradiance ? own.irradiance() : own.radiosity();
}

Result<void> make_map_folder(const std::string& folder) {
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (std::filesystem::is_directory(folder)) return {};
    return Error{ErrorCode::cannot_write,
                 "cannot make the folder " + folder + (failed ? ": " + failed.message() : ": a file has its name"),
                 folder, ""};
}

Spectrum texel_value(const Scene& scene, const LightMap& map, const Chart& chart, std::size_t index,
                     LightMapQuantity quantity) {
    const Spectrum irradiance = map.at(index);
    if (quantity == LightMapQuantity::irradiance) return irradiance;
    const Material& material = scene.material(chart.region);
    const Spectrum emitted = map.has_emission ? material.exitance : Spectrum();
    return emitted + material.reflectance * irradiance;
}

Image map_picture(const Scene& scene, const LightMaps& light, std::size_t map, LightMapQuantity quantity,
                  const ToneMap& tones) {
    const LightMap& values = light.maps[map];
    Image image(values.size.width, values.size.height);
    for_each_texel(light, map, [&](const Chart& chart, std::size_t i) {
        set_pixel(image, i, tones(texel_value(scene, values, chart, i, quantity)));
    });
    return image;
}

Result<void> write_group_light_maps(const Scene& lit_by_group, const LightMaps& light, std::size_t group,
                                    const LightMapFormat& format, const std::string& folder) {
    if (const Result<void> made = make_map_folder(folder); !made) return made;
    return write_pictures(lit_by_group, light, group, format, folder);
}

Result<void> write_light_maps(const Solution& solution, const LightMaps& light, const LightMapFormat& format,
                              std::span<const std::string> groups, const std::string& folder) {
    if (const Result<void> made = make_map_folder(folder); !made) return made;
    const Scene& scene = solution.scene;
    if (const Result<void> written = write_pictures(scene, light, {}, format, folder); !written) return written;
    ToneMap tone = make_tone_map(solution);
    tone.curve = ToneCurve::filmic;
    const Result<void> written = write_light_map_glb(solution, light, format, tone, folder + "/scene.glb");
    if (!written) return written;
    return write_file(folder + "/lightmaps.json", manifest(scene, light, format, tone, groups));
}

}  // namespace exitance
