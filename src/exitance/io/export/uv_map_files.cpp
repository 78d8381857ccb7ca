#include "exitance/io/export/uv_map_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/limits.hpp"
#include "exitance/base/random.hpp"
#include "exitance/base/version.hpp"
#include "exitance/base/words.hpp"
#include "exitance/io/export/directional_files.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/pictures/display.hpp"
#include "exitance/io/scenes/obj/obj_writer.hpp"
#include "exitance/io/scenes/textures/scene_textures.hpp"
#include "exitance/measure/light_maps/texel_cover.hpp"

namespace exitance {
namespace {

const UvLightMap::Values& values_of(const UvLightMap& map, LightMapQuantity quantity) {
    return quantity == LightMapQuantity::irradiance ? map.light.irradiance : map.radiosity;
}

Spectrum value_at(const UvLightMap::Values& values, std::size_t i) {
    Spectrum out;
    for (std::size_t b = 0; b < bands; ++b) out[b] = static_cast<double>(values[i][b]);
    return out;
}

LinearImage uv_numbers(const UvLightMap& map, LightMapQuantity quantity) {
    LinearImage image{map.light.size.width, map.light.size.height, {}};
    const std::size_t texels = map.light.size.texels();
    for (const char* name : {"R", "G", "B"}) image.channels.push_back({name, std::vector<float>(texels)});
    const UvLightMap::Values& values = values_of(map, quantity);
    for (std::size_t i = 0; i < texels; ++i) {
        const auto rgb = red_green_blue(value_at(values, i));
        for (std::size_t c = 0; c < 3; ++c) image.channels[c].values[i] = static_cast<float>(rgb[c]);
    }
    image.channels.push_back({"coverage", map.light.share});
    return image;
}

/// Tone map that brings the median of the texels on charts to middle grey.
ToneMap uv_tones(const UvLightMaps& light, LightMapQuantity quantity) {
    std::vector<double> levels;
    for (const UvLightMap& map : light.maps)
        for (std::size_t i = 0; i < map.light.size.texels(); ++i)
            if (map.light.share[i] > 0)
                if (const double value = mean(value_at(values_of(map, quantity), i)); value > 0)
                    levels.push_back(value);
    constexpr double middle_grey = 0.18;
    ToneMap tones;
    tones.curve = ToneCurve::filmic;
    if (levels.empty()) return tones;
    const auto middle = levels.begin() + static_cast<std::ptrdiff_t>(levels.size() / 2);
    std::nth_element(levels.begin(), middle, levels.end());
    tones.scale = middle_grey / *middle;
    return tones;
}

Image uv_preview(const UvLightMap& map, LightMapQuantity quantity, const ToneMap& tones) {
    Image image(map.light.size.width, map.light.size.height);
    for (std::size_t i = 0; i < map.light.size.texels(); ++i) {
        set_pixel(image, i, tones(value_at(values_of(map, quantity), i)));
    }
    return image;
}

std::string unwrapped_json(const Unwrapped& unwrapped) {
    return fmt::format(
        "\n  \"model\": \"scene.glb\",\n  \"unwrapped\": {{\"charts\": {}, \"filled\": {:.6g}, "
        "\"smallest_scale\": {:.6g}}},",
        unwrapped.charts, unwrapped.filled, unwrapped.smallest_scale);
}

std::string object_json(const UvObject& o, const UvLightMap& map) {
    const double density =
        std::sqrt(static_cast<double>(map.light.size.texels()) * o.map_area / std::max(o.area, min_divisor));
    return fmt::format(
        "    {{\"name\": {}, \"map\": {}, \"triangles\": {}, \"charts\": {}, \"texels_per_metre\": {:.6g}, "
        "\"overlapping\": {}, \"overlaps_others\": {}, \"outside\": {}, \"moved_charts\": {}, \"mirrored\": {}, "
        "\"collapsed\": {}}}",
        json_text(o.name), o.map, o.triangles, o.charts, density, o.overlapping, o.overlaps_others, o.outside,
        o.moved_charts, o.mirrored, o.collapsed);
}

}  // namespace

Result<void> write_uv_pictures(const Scene& scene, const UvLightMaps& light, std::optional<std::size_t> group,
                               const LightMapFormat& format, const std::string& folder) {
    if (const Result<void> made = make_map_folder(folder); !made) return made;
    const ToneMap tones = uv_tones(light, format.quantity);
    const std::string_view unit = unit_of(scene, format.quantity);
    const std::string quantity = values_name(format);
    for (std::size_t m = 0; m < light.maps.size(); ++m) {
        const std::string stem = folder + "/" + light_map_stem(m, group);
        const LinearImage image = uv_numbers(light.maps[m], format.quantity);
        if (const Result<void> written = write_map_numbers(stem, image, scene, format); !written) return written;
        const ImageTexts texts{
            {"Software", "exitance"},
            {"Exposure", fmt::format("{} in {} times {:.6g}, then a filmic curve", quantity, unit, tones.scale)}};
        const Result<void> written = write_png(stem + ".png", uv_preview(light.maps[m], format.quantity, tones), texts);
        if (!written) return written;
        const Result<void> directed = write_directional(light.maps[m].light, m, group, scene, format, folder);
        if (!directed) return directed;
    }
    return {};
}

Result<void> write_uv_manifest(const Scene& scene, const UvSet& set, const UvLightMaps& light,
                               const LightMapFormat& format, std::span<const std::string> groups,
                               std::span<const std::string> charts, const Unwrapped* unwrapped,
                               const std::string& folder) {
    std::string text = fmt::format(
        "{{\n  \"version\": 1,\n  \"generator\": \"exitance {}\",\n  \"quantity\": \"{}\",\n  \"component\": \"{}\",\n"
        "  \"unit\": \"{}\",\n  \"uv\": {{\"file\": {}, \"set\": \"{}\"}},\n  \"padding\": {},\n  \"maps\": [",
        program_version, name_of(format.quantity), name_of(format.component), unit_of(scene, format.quantity),
        json_text(set.file), set.name, light.padding);
    for (std::size_t m = 0; m < light.maps.size(); ++m) {
        const UvLightMap& map = light.maps[m];
        text += fmt::format(
            "{}\n    {{{}, \"width\": {}, \"height\": {}, "
            "\"texels_per_metre\": {:.6g}, \"shared_texels\": {}, \"close_texels\": {}{}}}",
            m > 0 ? "," : "", map_files_json(m, format), map.light.size.width, map.light.size.height, map.density,
            map.shared_texels, map.close_texels,
            charts.empty() ? std::string() : fmt::format(", \"charts\": {}", json_text(charts[m])));
    }
    text += groups_json(groups, light.maps.size(), format);
    text += "\n  ]," + directional_json(scene, format) + curved_json(light.curved) +
            (unwrapped ? unwrapped_json(*unwrapped) : "") + "\n  \"objects\": [";
    const char* comma = "\n";
    for (const UvObject& object : light.layout.objects) {
        if (object.triangles == 0) continue;
        text += comma + object_json(object, light.maps[object.map]);
        comma = ",\n";
    }
    return write_file(folder + "/lightmaps.json", text + "\n  ]\n}\n");
}

Result<std::string> write_unwrapped_model(const Solution& solution, const Unwrapped& unwrapped,
                                          const UvLightMaps& light, const LightMapFormat& format,
                                          const std::string& folder) {
    const Scene& scene = solution.scene;
    ToneMap tone = make_tone_map(solution);
    tone.curve = ToneCurve::filmic;
    const LightMaps maps = as_region_charts(unwrapped, light);
    if (const Result<void> written = write_light_map_glb(solution, maps, format, tone, folder + "/scene.glb"); !written)
        return written.error();
    const std::optional<SceneTextures> own = load_scene_textures(scene, format.scene_file);
    const std::string name = own && own->has_second_set() ? "TEXCOORD_2" : "TEXCOORD_1";
    if (ending(scene.file()) != ".obj") return name;
    std::vector<Vec2> places;
    for (const SurfaceId s : scene.surfaces().ids())
        for (const Point& p : scene.outline(s)) places.push_back(unwrapped.place(scene.surfaces()[s].region, p));
    const Result<void> written = write_obj(describe_polygons(scene), folder + "/scene.obj", places);
    if (!written) return written.error();
    return name;
}

Image draw_charts(const UvSet& set, const UvLightMaps& light, std::size_t m) {
    const UvLightMap& map = light.maps[m];
    const MapSize size = map.light.size;
    std::vector<float> covered(size.texels());
    std::vector<std::uint8_t> is_mirrored(size.texels());
    std::vector<Vec2> polygon, rest;
    for (std::size_t t = 0; t < set.triangles.size(); ++t) {
        const UvObject& object = light.layout.objects[set.triangles[t].object];
        if (object.map != m || light.layout.chart[t] == UvLayout::no_chart) continue;
        std::array<Vec2, 3> place = light.layout.places[t];
        for (Vec2& p : place) p = {p.x * size.width, p.y * size.height};
        const bool mirrored = cross(place[1] - place[0], place[2] - place[0]) > 0;
        const TexelOutline outline(place);
        const auto texel = [](double x, int most) { return static_cast<int>(std::clamp(x, 0.0, 1.0 * most)); };
        const int x1 = texel(std::ceil(outline.hi.x), size.width), y1 = texel(std::ceil(outline.hi.y), size.height);
        for (int y = texel(std::floor(outline.lo.y), size.height); y < y1; ++y)
            for (int x = texel(std::floor(outline.lo.x), size.width); x < x1; ++x) {
                polygon.assign(outline.corner.begin(), outline.corner.begin() + 3);
                clip_to_texel(polygon, x, y, rest);
                double area = 0;
                for (std::size_t i = 2; i < polygon.size(); ++i)
                    area += 0.5 * cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
                const std::size_t at = map.light.index(x, y);
                covered[at] += static_cast<float>(area);
                if (mirrored && area > 0) is_mirrored[at] = true;
            }
    }
    Image image(size.width, size.height);
    constexpr float more_than_whole = 1.001f;  // rounding of sums of areas is smaller
    for (std::size_t i = 0; i < size.texels(); ++i) {
        std::uint8_t* rgb = image.rgb.data() + 3 * i;
        if (map.chart[i] == UvLayout::no_chart) continue;
        const auto tint = static_cast<std::uint8_t>(hash(map.chart[i], 0) % 96);
        if (covered[i] > more_than_whole)
            rgb[0] = 255, rgb[1] = rgb[2] = 0;
        else if (is_mirrored[i])
            rgb[0] = tint, rgb[1] = static_cast<std::uint8_t>(64 + tint), rgb[2] = 224;
        else
            rgb[0] = static_cast<std::uint8_t>(64 + tint), rgb[1] = static_cast<std::uint8_t>(224 - tint), rgb[2] = 96;
        if (covered[i] == 0)
            for (std::size_t c = 0; c < 3; ++c) rgb[c] /= 4;
    }
    return image;
}

std::vector<std::string> chart_warnings(const UvSet& set, const UvLightMaps& light) {
    std::vector<std::string> out;
    constexpr std::size_t max_names = 5;
    const auto list = [&](std::size_t UvObject::*count, const std::string& one, const std::string& several) {
        std::string names;
        std::size_t objects = 0, sum = 0;
        for (const UvObject& object : light.layout.objects) {
            if (object.*count == 0) continue;
            sum += object.*count;
            if (++objects <= max_names)
                names += fmt::format("{}'{}' ({})", objects > 1 ? ", " : "", object.name, object.*count);
        }
        if (objects > max_names) names += fmt::format(" and {} more objects", objects - max_names);
        if (sum > 0) out.push_back(fmt::format("{} {}: {}", sum, sum == 1 ? one : several, names));
    };
    list(&UvObject::overlapping,
         "triangle overlaps others of its object in the map, where both get the mean of their light (--uv unwrap makes "
         "coordinates that do not overlap)",
         "triangles overlap others of their object in the map, where both get the mean of their light (--uv unwrap "
         "makes coordinates that do not overlap)");
    list(&UvObject::outside, "triangle is partly outside of the map, and has no texels there",
         "triangles are partly outside of the map, and have no texels there");
    list(&UvObject::moved_charts, "chart was moved into the map by whole numbers, as repeated textures are read",
         "charts were moved into the map by whole numbers, as repeated textures are read");
    list(&UvObject::mirrored, "triangle is mirrored in the map", "triangles are mirrored in the map");
    list(&UvObject::collapsed, "triangle has no area in the map, and no texels",
         "triangles have no area in the map, and no texels");
    std::size_t shared = 0, close = 0;
    for (const UvLightMap& map : light.maps) shared += map.shared_texels, close += map.close_texels;
    if (shared > 0) out.push_back(fmt::format("{} texels are shared by several charts, whose light they mix", shared));
    if (close > 0)
        out.push_back(fmt::format(
            "{} texels between charts are read for several of them: leave two texels between charts", close));
    if (set.back_faces > 0)
        out.push_back(fmt::format("the backs of {} double-sided faces have no texels", set.back_faces));
    if (light.layout.maps > 1) out.push_back("charts of different objects overlap: each object has a map of its own");
    return out;
}

}  // namespace exitance
