#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "exitance/base/triangulation.hpp"
#include "exitance/base/version.hpp"
#include "exitance/base/words.hpp"
#include "exitance/io/export/glb_container.hpp"
#include "exitance/io/export/glb_nodes.hpp"
#include "exitance/io/export/light_map_files.hpp"
#include "exitance/io/export/reflected_maps.hpp"
#include "exitance/io/pictures/display.hpp"
#include "exitance/io/pictures/png.hpp"

namespace exitance {
namespace {

using Float2 = std::array<float, 2>;

/// Faces of one group, material and map.
struct MapPrimitive {
    std::uint32_t group = 0, material = 0, map = 0;
    GlbPart part = {};

    auto key() const { return std::tuple(group, material, map); }
};

struct Mesh {
    std::vector<Float3> position, normal;
    /// Texture coordinates: of the scene or of the plane; the scene's second set or none; in the maps.
    std::vector<Float2> place, second_place, map_place;
    std::vector<std::uint32_t> index;  ///< Relative to the first vertex of the primitive.
    std::vector<MapPrimitive> primitives;
};

Float2 floats(Vec2 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y)};
}

void add_face(const Scene& scene, SurfaceId s, const Chart& chart, const LightMaps& light,
              const SceneTextures* textures, Mesh& mesh) {
    GlbPart& part = mesh.primitives.back().part;
    const MapSize size = light.maps[chart.map].size;
    const Surface& face = scene.surfaces()[s];
    const std::span<const Point> outline = scene.outline(s);
    for (const auto& triangle : triangulate(outline, face.normal))
        for (const std::uint32_t corner : triangle)
            mesh.index.push_back(static_cast<std::uint32_t>(part.vertices + corner));
    for (std::size_t k = 0; k < outline.size(); ++k) {
        const Vec2 place = chart.place(outline[k]);
        mesh.position.push_back(y_up(outline[k])), mesh.normal.push_back(y_up(face.normal));
        mesh.place.push_back(floats(textures ? textures->places[0][face.first_corner + k]
                                             : Vec2{place.x / light.density, place.y / light.density}));
        if (textures && textures->has_second_set())
            mesh.second_place.push_back(floats(textures->places[1][face.first_corner + k]));
        mesh.map_place.push_back(floats({(chart.x + place.x) / size.width, (chart.y + place.y) / size.height}));
        part.include(mesh.position.back());
    }
    part.vertices = mesh.position.size() - part.first_vertex;
    part.indices = mesh.index.size() - part.first_index;
}

Mesh make_mesh(const Scene& scene, const LightMaps& light, const SceneTextures* textures) {
    const auto primitive_of = [&](SurfaceId s) {
        const Surface& face = scene.surfaces()[s];
        return MapPrimitive{face.group.value, face.material.value, light.charts[face.region.value].map};
    };
    std::vector<SurfaceId> order;
    for (SurfaceId s : scene.surfaces().ids()) order.push_back(s);
    std::stable_sort(order.begin(), order.end(),
                     [&](SurfaceId a, SurfaceId b) { return primitive_of(a).key() < primitive_of(b).key(); });
    Mesh mesh;
    for (const SurfaceId s : order) {
        MapPrimitive primitive = primitive_of(s);
        if (mesh.primitives.empty() || mesh.primitives.back().key() != primitive.key()) {
            primitive.part = {.first_vertex = mesh.position.size(), .first_index = mesh.index.size()};
            mesh.primitives.push_back(primitive);
        }
        add_face(scene, s, light.charts[scene.surfaces()[s].region.value], light, textures, mesh);
    }
    return mesh;
}

struct TextureLevels {
    double peak = 1;             ///< Value of the brightest colour of a texture, W/m^2.
    std::vector<Spectrum> mean;  ///< Mean irradiance per material, W/m^2.
};

TextureLevels find_levels(const Scene& scene, const LightMaps& light, const LightMaps& shown, const ToneMap& tone) {
    // The eight bits cover the range of a display and at least two stops above white.
    constexpr double whites = 4;
    TextureLevels levels;
    levels.mean.resize(scene.materials().size());
    std::vector<double> weights(scene.materials().size());
    double peak = 0;
    for (std::size_t m = 0; m < light.maps.size(); ++m)
        for_each_texel(light, m, [&](const Chart& chart, std::size_t i) {
            const auto share = static_cast<double>(light.maps[m].share[i]);
            const std::uint32_t material = scene.regions()[chart.region].material.value;
            levels.mean[material] += share * light.maps[m].at(i), weights[material] += share;
            if (scene.material(chart.region).emits()) return;
            const auto rgb = red_green_blue(shown.maps[m].at(i));
            peak = std::max({peak, rgb[0], rgb[1], rgb[2]});
        });
    for (std::size_t i = 0; i < weights.size(); ++i)
        if (weights[i] > 0) levels.mean[i] *= 1 / weights[i];
    if (peak > 0) levels.peak = std::min(peak, whites / tone.scale);
    return levels;
}

/// An array with one row per vertex.
struct VertexArray {
    std::string name;
    std::size_t stride;  ///< Bytes.
    std::span<const std::byte> bytes;
};

std::vector<VertexArray> vertex_arrays(const Mesh& mesh) {
    std::vector<VertexArray> out{{"POSITION", sizeof(Float3), std::as_bytes(std::span(mesh.position))},
                                 {"NORMAL", sizeof(Float3), std::as_bytes(std::span(mesh.normal))}};
    for (const auto* places : {&mesh.place, &mesh.second_place, &mesh.map_place})
        if (!places->empty())
            out.push_back(
                {fmt::format("TEXCOORD_{}", out.size() - 2), sizeof(Float2), std::as_bytes(std::span(*places))});
    return out;
}

/// The texture of a map: light divided by the peak or, for unlit materials, the tone-mapped picture including emission.
Image texture(const Scene& scene, const LightMaps& shown, std::size_t m, LightMapMaterial way, const ToneMap& tone,
              double peak) {
    const LightMap& map = shown.maps[m];
    Image image(map.size.width, map.size.height);
    for_each_texel(shown, m, [&](const Chart& chart, std::size_t i) {
        const DisplayColour colour = way == LightMapMaterial::unlit
                                         ? tone(scene.material(chart.region).exitance + map.at(i))
                                         : red_green_blue(map.at(i) / peak);
        set_pixel(image, i, colour);
    });
    return image;
}

/// Formats an emissive colour; components above 1 are expressed by its strength. `texture` is empty or ",...".
std::string emission(std::array<double, 3> colour, const std::string& texture, std::string& extensions) {
    const double strength = std::max({colour[0], colour[1], colour[2], 1e-30});
    for (double& c : colour) c /= strength;
    extensions += fmt::format(",\"KHR_materials_emissive_strength\":{{\"emissiveStrength\":{}}}", strength);
    return fmt::format(",\"emissiveFactor\":{}{}", json_triple(colour), texture);
}

/// Images and textures of a document: the maps, then one per material with its own picture.
struct Textures {
    std::vector<std::string> files;  ///< PNG or JPEG.
    std::string images, textures, samplers;
    int light_set = 1;                    ///< Number of the texture coordinate set for the maps.
    Field<MaterialId, std::string> base;  ///< Per material: JSON reference to its own picture; empty if it has none.

    void add_file(const std::string& file, const std::string& name, const std::string& kind, std::size_t first_view) {
        images += fmt::format("{}{{\"name\":{},\"mimeType\":\"{}\",\"bufferView\":{}}}", images.empty() ? "" : ",",
                              json_text(name), kind, first_view + files.size());
        files.push_back(file);
    }
    std::size_t add_texture(std::size_t source, int wrap_s, int wrap_t) {
        const char* comma = count == 0 ? "" : ",";
        textures += fmt::format("{}{{\"sampler\":{},\"source\":{}}}", comma, count, source);
        samplers +=
            fmt::format("{}{{\"magFilter\":9729,\"minFilter\":9987,\"wrapS\":{},\"wrapT\":{}}}", comma, wrap_s, wrap_t);
        return count++;
    }
    std::size_t count = 0;
};

std::string map_material_json(const Scene& scene, MaterialId id, std::size_t map, LightMapMaterial way,
                              const ToneMap& tone, const TextureLevels& levels, const Textures& textures) {
    const Material& material = scene.materials()[id];
    const auto rho = red_green_blue(material.reflectance), exitance = red_green_blue(material.exitance);
    const std::string light = fmt::format("{{\"index\":{},\"texCoord\":{}}}", map, textures.light_set);
    std::string base = "[0,0,0,1]", base_texture, emitted, extensions;
    if (way != LightMapMaterial::unlit) base_texture = textures.base[id];
    if (way == LightMapMaterial::unlit) {
        base = "[1,1,1,1]", base_texture = ",\"baseColorTexture\":" + light;
        extensions = ",\"KHR_materials_unlit\":{}";
    } else if (material.emits()) {
        const Spectrum radiosity = material.exitance + material.reflectance * levels.mean[id.value];
        emitted = emission(red_green_blue(tone.scale * radiosity), "", extensions);
    } else if (way == LightMapMaterial::emissive) {
        // The factor is grey, since the importer of Blender 3.4 confuses the channels of coloured ones.
        const double strength = tone.scale * levels.peak;
        emitted = emission({strength, strength, strength}, ",\"emissiveTexture\":" + light, extensions);
    } else {
        // For a textured material, the picture has the reflectance; factors above 1 are not possible.
        base = base_texture.empty() ? fmt::format("[{},{},{},1]", rho[0], rho[1], rho[2]) : "[1,1,1,1]";
        extensions = fmt::format(",\"MOZ_lightmap\":{{\"index\":{},\"texCoord\":{},\"intensity\":{}}}", map,
                                 textures.light_set, pi * tone.scale * levels.peak);
    }
    // Two extensions make the surface black without highlights, so that a viewer's lights add nothing.
    if (way != LightMapMaterial::unlit)
        extensions += ",\"KHR_materials_specular\":{\"specularFactor\":0},\"KHR_materials_ior\":{\"ior\":1}";
    return fmt::format(
        "{{\"name\":{},\"pbrMetallicRoughness\":{{\"baseColorFactor\":{},\"metallicFactor\":0,\"roughnessFactor\":1{}}}"
        "{},\"extensions\":{{{}}},\"extras\":{{\"reflectance\":{},\"exitance\":{}}}}}",
        json_text(material.name), base, base_texture, emitted, extensions.substr(1), json_triple(rho),
        json_triple(exitance));
}

/// Builds the JSON of a document. The binary chunk has one view per array, then one per texture.
class Document {
  public:
    Document(const Scene& scene, const Mesh& mesh, const Textures& textures)
        : scene_(scene), mesh_(mesh), textures_(textures) {
        add_views();
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> numbers;
        for (const MapPrimitive& p : mesh.primitives)
            if (numbers.emplace(std::pair(p.material, p.map), numbers.size()).second)
                material_of_.emplace_back(p.material, p.map);
        for (std::size_t first = 0, last = 0; first < mesh.primitives.size(); first = last) {
            std::string items;
            for (; last < mesh.primitives.size() && mesh.primitives[last].group == mesh.primitives[first].group; ++last)
                add_item(items, primitive_json(mesh.primitives[last], numbers.at({mesh.primitives[last].material,
                                                                                  mesh.primitives[last].map})));
            const std::string name = json_text(scene.groups()[GroupId(mesh.primitives[first].group)]);
            add_item(scene_nodes_, std::to_string(nodes_count_));
            add_item(nodes_, fmt::format("{{\"mesh\":{},\"name\":{}}}", nodes_count_++, name));
            add_item(meshes_, fmt::format("{{\"name\":{},\"primitives\":[{}]}}", name, items));
        }
    }

    /// Material and map of each material of the document.
    const std::vector<std::pair<std::uint32_t, std::uint32_t>>& materials() const { return material_of_; }

    std::string text(const std::string& materials, const std::string& used, const ToneMap& tone,
                     const TextureLevels& levels) {
        GlbNodes placed = make_light_and_camera_nodes(scene_);
        // Lights are already in the maps, so viewers must not add them. Cameras come after lights among the nodes.
        std::string cameras;
        if (scene_.lights().empty() && placed.count > 0) {
            add_item(nodes_, placed.nodes), cameras = fmt::format("\"cameras\":[{}],", placed.cameras);
            for (std::size_t i = 0; i < placed.count; ++i) add_item(scene_nodes_, std::to_string(nodes_count_ + i));
        }
        std::string json = fmt::format(
            "{{\"asset\":{{\"version\":\"2.0\",\"generator\":\"exitance {}\",\"extras\":{{\"exposure\":{},"
            "\"texturePeak\":{},\"unit\":\"W/"
            "m^2\"}}}},\"extensionsUsed\":[{}],\"scene\":0,\"scenes\":[{{\"nodes\":[{}]}}"
            "],\"nodes\":[{}],\"meshes\":[{}],\"materials\":[{}],\"images\":[{}],\"textures\":[{}],\"samplers\":[{}],{}"
            "\"accessors\":[{}],"
            "\"bufferViews\":[{}],\"buffers\":[{{\"byteLength\":{}}}]}}",
            program_version, tone.scale, levels.peak, used, scene_nodes_, nodes_, meshes_, materials, textures_.images,
            textures_.textures, textures_.samplers, cameras, accessors_, views_, bytes_);
        json.resize((json.size() + 3) / 4 * 4, ' ');
        return json;
    }

  private:
    void add_view(std::size_t bytes, const std::string& more) {
        add_item(views_, fmt::format("{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}{}}}", bytes_, bytes, more));
        bytes_ += (bytes + 3) / 4 * 4;
    }
    void add_views() {
        for (const VertexArray& array : vertex_arrays(mesh_))
            add_view(array.bytes.size(), fmt::format(",\"byteStride\":{},\"target\":34962", array.stride));
        add_view(mesh_.index.size() * 4, ",\"target\":34963");
        for (const std::string& file : textures_.files) add_view(file.size(), "");
    }

    std::string primitive_json(const MapPrimitive& p, std::size_t material) {
        std::string attributes;
        const std::vector<VertexArray> arrays = vertex_arrays(mesh_);
        for (std::size_t a = 0; a < arrays.size(); ++a) {
            add_item(accessors_, vertex_accessor(p.part, a, arrays[a].stride, a < 2 ? "VEC3" : "VEC2", a == 0));
            add_item(attributes, fmt::format("\"{}\":{}", arrays[a].name, accessor_count_++));
        }
        add_item(accessors_, index_accessor(p.part, arrays.size()));
        return fmt::format("{{\"attributes\":{{{}}},\"indices\":{},\"material\":{}}}", attributes, accessor_count_++,
                           material);
    }

    const Scene& scene_;
    const Mesh& mesh_;
    const Textures& textures_;
    std::string nodes_, scene_nodes_, meshes_, accessors_, views_;
    std::size_t nodes_count_ = 0, accessor_count_ = 0, bytes_ = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> material_of_;
};

/// Collects the maps as pictures, and the scene's own pictures if materials show them.
Result<Textures> make_textures(const Scene& scene, const LightMaps& shown, LightMapMaterial way, const ToneMap& tone,
                               double peak, const SceneTextures* own) {
    constexpr int clamp = 33071;
    Textures out;
    const bool two_sets = own && own->has_second_set();
    out.light_set = two_sets ? 2 : 1;
    out.base.resize(scene.materials().size());
    // number of the first buffer view after those of vertex arrays and indices
    const std::size_t first_view = two_sets ? 6 : 5;
    for (std::size_t m = 0; m < shown.maps.size(); ++m) {
        const Result<std::string> png = encode_png(texture(scene, shown, m, way, tone, peak), {});
        if (!png) return png.error();
        out.add_file(*png, fmt::format("lightmap_{}", m), "image/png", first_view);
        out.add_texture(m, clamp, clamp);
    }
    if (!own || way == LightMapMaterial::unlit) return out;
    for (std::size_t p = 0; p < own->pictures.size(); ++p)
        out.add_file({own->pictures[p].file.begin(), own->pictures[p].file.end()}, fmt::format("picture_{}", p),
                     own->pictures[p].kind, first_view);
    std::map<std::array<int, 3>, std::size_t> numbers;  // numbers of the textures, by picture and wrap modes
    for (MaterialId id : scene.materials().ids()) {
        const SceneTextures::Coat& coat = own->coats[id];
        if (coat.picture < 0 || own->places[coat.set].empty()) continue;
        const auto [number_of, is_new] = numbers.try_emplace({coat.picture, coat.wrap_s, coat.wrap_t});
        if (is_new)
            number_of->second =
                out.add_texture(shown.maps.size() + static_cast<std::size_t>(coat.picture), coat.wrap_s, coat.wrap_t);
        const std::size_t number = number_of->second;
        out.base[id] = fmt::format(",\"baseColorTexture\":{{\"index\":{},\"texCoord\":{}}}", number, coat.set);
    }
    return out;
}

}  // namespace

Result<void> write_light_map_glb(const Solution& solution, const LightMaps& light, const LightMapFormat& format,
                                 const ToneMap& tone, const std::string& path) {
    const Scene& scene = solution.scene;
    const std::optional<SceneTextures> own = load_scene_textures(scene, format.scene_file);
    const LightMapMaterial material = format.material;
    const SceneTextures* textures_of_scene = own ? &*own : nullptr;
    const bool as_received = material == LightMapMaterial::moz_lightmap;
    const LightMaps reflected = as_received ? LightMaps() : reflected_maps(scene, light, textures_of_scene);
    const LightMaps& shown = as_received ? light : reflected;
    const TextureLevels levels = find_levels(scene, light, shown, tone);
    Result<Textures> textures = make_textures(scene, shown, material, tone, levels.peak, textures_of_scene);
    if (!textures) return textures.error();
    const Mesh mesh = make_mesh(scene, light, textures_of_scene);
    Document document(scene, mesh, *textures);
    std::string materials, used;
    for (const auto& [number, map] : document.materials())
        add_item(materials, map_material_json(scene, MaterialId(number), map, material, tone, levels, *textures));
    for (const char* extension : {"KHR_materials_unlit", "KHR_materials_emissive_strength", "MOZ_lightmap",
                                  "KHR_materials_specular", "KHR_materials_ior"})
        if (materials.find(fmt::format("\"{}\":", extension)) != std::string::npos)
            add_item(used, fmt::format("\"{}\"", extension));
    const std::string json = document.text(materials, used, tone, levels);
    std::vector<std::span<const std::byte>> parts;
    for (const VertexArray& array : vertex_arrays(mesh)) parts.push_back(array.bytes);
    parts.push_back(std::as_bytes(std::span(mesh.index)));
    for (std::string& file : textures->files) {
        file.resize((file.size() + 3) / 4 * 4);
        parts.push_back(std::as_bytes(std::span(file)));
    }
    return write_glb_container(path, json, parts, "bake with a smaller --density");
}

}  // namespace exitance
