#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "exitance/geometry/triangulation.hpp"
#include "exitance/io/export/glb_container.hpp"
#include "exitance/io/export/glb_nodes.hpp"
#include "exitance/io/export/light_map_files.hpp"
#include "exitance/io/pictures/png.hpp"

namespace exitance {
namespace {

using Float3 = std::array<float, 3>;
using Float2 = std::array<float, 2>;

/// glTF has Y up where scenes have Z up.
Float3 y_up(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.z), static_cast<float>(-v.y)};
}

/// Faces of one group, material and map: a range of all vertices and of all indices.
struct Primitive {
    std::uint32_t group = 0, material = 0, map = 0;
    std::size_t first_vertex = 0, vertices = 0, first_index = 0, indices = 0;
    Float3 lo = {HUGE_VALF, HUGE_VALF, HUGE_VALF}, hi = {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};

    auto key() const { return std::tuple(group, material, map); }
};

struct Mesh {
    std::vector<Float3> position, normal;
    std::vector<Float2> plane_place, map_place;
    std::vector<std::uint32_t> index;  ///< Counted from the first vertex of its primitive.
    std::vector<Primitive> primitives;
};

void add_face(const Scene& scene, SurfaceId s, const Chart& chart, const LightMaps& light, Mesh& mesh) {
    Primitive& primitive = mesh.primitives.back();
    const MapSize size = light.maps[chart.map].size;
    const Normal& n = scene.surfaces()[s].normal;
    for (const auto& triangle : triangulate(scene.outline(s), n))
        for (const std::uint32_t corner : triangle)
            mesh.index.push_back(static_cast<std::uint32_t>(primitive.vertices + corner));
    for (const Point& p : scene.outline(s)) {
        const Vec2 place = chart.place(p);
        mesh.position.push_back(y_up(p)), mesh.normal.push_back(y_up(n));
        mesh.plane_place.push_back(
            {static_cast<float>(place.x / light.density), static_cast<float>(place.y / light.density)});
        mesh.map_place.push_back({static_cast<float>((chart.x + place.x) / size.width),
                                  static_cast<float>((chart.y + place.y) / size.height)});
        for (std::size_t axis = 0; axis < 3; ++axis) {
            primitive.lo[axis] = std::min(primitive.lo[axis], mesh.position.back()[axis]);
            primitive.hi[axis] = std::max(primitive.hi[axis], mesh.position.back()[axis]);
        }
    }
    primitive.vertices = mesh.position.size() - primitive.first_vertex;
    primitive.indices = mesh.index.size() - primitive.first_index;
}

Mesh make_mesh(const Scene& scene, const LightMaps& light) {
    const auto primitive_of = [&](SurfaceId s) {
        const Surface& face = scene.surfaces()[s];
        return Primitive{face.group.value, face.material.value, light.charts[face.region.value].map};
    };
    std::vector<SurfaceId> order;
    for (SurfaceId s : scene.surfaces().ids()) order.push_back(s);
    std::stable_sort(order.begin(), order.end(),
                     [&](SurfaceId a, SurfaceId b) { return primitive_of(a).key() < primitive_of(b).key(); });
    Mesh mesh;
    for (const SurfaceId s : order) {
        Primitive primitive = primitive_of(s);
        if (mesh.primitives.empty() || mesh.primitives.back().key() != primitive.key()) {
            primitive.first_vertex = mesh.position.size(), primitive.first_index = mesh.index.size();
            mesh.primitives.push_back(primitive);
        }
        add_face(scene, s, light.charts[scene.surfaces()[s].region.value], light, mesh);
    }
    return mesh;
}

/// What textures hold, W/m^2: what reflecting surfaces send out, or for MOZ_lightmap what they receive.
Spectrum stored(const Scene& scene, const LightMap& map, const Chart& chart, std::size_t i, LightMapMaterial way) {
    return way == LightMapMaterial::moz_lightmap ? map.at(i) : scene.material(chart.region).reflectance * map.at(i);
}

struct TextureLevels {
    double peak = 1;             ///< What the brightest colour of a texture stands for, W/m^2.
    std::vector<Spectrum> mean;  ///< Mean irradiance of a material, W/m^2.
};

TextureLevels find_levels(const Scene& scene, const LightMaps& light, LightMapMaterial way, const ToneMap& tone) {
    // Eight bits are spent on what a display shows: two stops above white are kept, at least.
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
            const auto rgb = red_green_blue(stored(scene, light.maps[m], chart, i, way));
            peak = std::max({peak, rgb[0], rgb[1], rgb[2]});
        });
    for (std::size_t i = 0; i < weights.size(); ++i)
        if (weights[i] > 0) levels.mean[i] *= 1 / weights[i];
    if (peak > 0) levels.peak = std::min(peak, whites / tone.scale);
    return levels;
}

/// What a texture shows: light over the peak, or the toned picture of radiosity.
Image texture(const Scene& scene, const LightMaps& light, std::size_t m, LightMapMaterial way, const ToneMap& tone,
              double peak) {
    const LightMap& map = light.maps[m];
    Image image(map.size.width, map.size.height);
    for_each_texel(light, m, [&](const Chart& chart, std::size_t i) {
        const DisplayColour colour = way == LightMapMaterial::unlit
                                         ? tone(texel_value(scene, map, chart, i, LightMapQuantity::radiosity))
                                         : red_green_blue(stored(scene, map, chart, i, way) / peak);
        for (std::size_t c = 0; c < 3; ++c)
            image.rgb[3 * i + c] =
                static_cast<std::uint8_t>(std::lround(255 * srgb_encoded(std::clamp(colour[c], 0.0, 1.0))));
    });
    return image;
}

template <class Triple>
std::string triple(const Triple& v) {
    return fmt::format("[{},{},{}]", v[0], v[1], v[2]);
}

/// Emission of these colours, above 1 by its strength; `texture` is empty or ",...".
std::string emission(std::array<double, 3> colour, const std::string& texture, std::string& extensions) {
    const double strength = std::max({colour[0], colour[1], colour[2], 1e-30});
    for (double& c : colour) c /= strength;
    extensions += fmt::format(",\"KHR_materials_emissive_strength\":{{\"emissiveStrength\":{}}}", strength);
    return fmt::format(",\"emissiveFactor\":{}{}", triple(colour), texture);
}

std::string material_json(const Material& material, std::size_t map, LightMapMaterial way, const ToneMap& tone,
                          const TextureLevels& levels, const Spectrum& mean_irradiance) {
    const auto rho = red_green_blue(material.reflectance), exitance = red_green_blue(material.exitance);
    const std::string texture = fmt::format("{{\"index\":{},\"texCoord\":1}}", map);
    std::string base = "[0,0,0,1]", base_texture, emitted, extensions;
    if (way == LightMapMaterial::unlit) {
        base = "[1,1,1,1]", base_texture = ",\"baseColorTexture\":" + texture;
        extensions = ",\"KHR_materials_unlit\":{}";
    } else if (material.emits()) {
        emitted = emission(red_green_blue(tone.scale * (material.exitance + material.reflectance * mean_irradiance)),
                           "", extensions);
    } else if (way == LightMapMaterial::emissive) {
        // The factor is grey: the importer of Blender 3.4 mixes up coloured ones.
        const double strength = tone.scale * levels.peak;
        emitted = emission({strength, strength, strength}, ",\"emissiveTexture\":" + texture, extensions);
    } else {
        base = fmt::format("[{},{},{},1]", rho[0], rho[1], rho[2]);
        extensions = fmt::format(",\"MOZ_lightmap\":{{\"index\":{},\"texCoord\":1,\"intensity\":{}}}", map,
                                 pi * tone.scale * levels.peak);
    }
    // A black surface without highlights, told in both ways: a viewer's own lights add nothing.
    if (way != LightMapMaterial::unlit)
        extensions += ",\"KHR_materials_specular\":{\"specularFactor\":0},\"KHR_materials_ior\":{\"ior\":1}";
    return fmt::format(
        "{{\"name\":{},\"pbrMetallicRoughness\":{{\"baseColorFactor\":{},\"metallicFactor\":0,\"roughnessFactor\":1{}}}"
        "{},\"extensions\":{{{}}},\"extras\":{{\"reflectance\":{},\"exitance\":{}}}}}",
        json_text(material.name), base, base_texture, emitted, extensions.substr(1), triple(rho), triple(exitance));
}

void add(std::string& list, const std::string& item) {
    list += (list.empty() ? "" : ",") + item;
}

/// JSON of a document in the making; the binary chunk has a view an array, then one a texture.
class Document {
  public:
    Document(const Scene& scene, const Mesh& mesh, std::span<const std::string> textures)
        : scene_(scene), mesh_(mesh), textures_(textures) {
        add_views();
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> numbers;
        for (const Primitive& p : mesh.primitives)
            if (numbers.emplace(std::pair(p.material, p.map), numbers.size()).second)
                material_of_.emplace_back(p.material, p.map);
        for (std::size_t first = 0, last = 0; first < mesh.primitives.size(); first = last) {
            std::string items;
            for (; last < mesh.primitives.size() && mesh.primitives[last].group == mesh.primitives[first].group; ++last)
                add(items, primitive_json(mesh.primitives[last],
                                          numbers.at({mesh.primitives[last].material, mesh.primitives[last].map})));
            const std::string name = json_text(scene.groups()[GroupId(mesh.primitives[first].group)]);
            add(scene_nodes_, std::to_string(nodes_count_));
            add(nodes_, fmt::format("{{\"mesh\":{},\"name\":{}}}", nodes_count_++, name));
            add(meshes_, fmt::format("{{\"name\":{},\"primitives\":[{}]}}", name, items));
        }
    }

    /// Material and map of every material of the document.
    const std::vector<std::pair<std::uint32_t, std::uint32_t>>& materials() const { return material_of_; }

    std::string text(const std::string& materials, const std::string& used, const ToneMap& tone,
                     const TextureLevels& levels) {
        GlbNodes placed = make_light_and_camera_nodes(scene_);
        // Lights are in the maps already: a viewer must not add them again. Cameras follow them among the nodes.
        std::string cameras;
        if (scene_.lights().empty() && placed.count > 0) {
            add(nodes_, placed.nodes), cameras = fmt::format("\"cameras\":[{}],", placed.cameras);
            for (std::size_t i = 0; i < placed.count; ++i) add(scene_nodes_, std::to_string(nodes_count_ + i));
        }
        std::string images, sources;
        for (std::size_t m = 0; m < textures_.size(); ++m) {
            add(images, fmt::format("{{\"name\":\"lightmap_{}\",\"mimeType\":\"image/png\",\"bufferView\":{}}}", m,
                                    arrays + m));
            add(sources, fmt::format("{{\"sampler\":0,\"source\":{}}}", m));
        }
        std::string json = fmt::format(
            "{{\"asset\":{{\"version\":\"2.0\",\"generator\":\"exitance {}\",\"extras\":{{\"exposure\":{},"
            "\"texturePeak\":{},\"unit\":\"W/"
            "m^2\"}}}},\"extensionsUsed\":[{}],\"scene\":0,\"scenes\":[{{\"nodes\":[{}]}}"
            "],\"nodes\":[{}],\"meshes\":[{}],\"materials\":[{}],\"images\":[{}],\"textures\":[{}],\"samplers\":[{{"
            "\"magFilter\":9729,\"minFilter\":9987,\"wrapS\":33071,\"wrapT\":33071}}],{}\"accessors\":[{}],"
            "\"bufferViews\":[{}],\"buffers\":[{{\"byteLength\":{}}}]}}",
            EXITANCE_VERSION, tone.scale, levels.peak, used, scene_nodes_, nodes_, meshes_, materials, images, sources,
            cameras, accessors_, views_, bytes_);
        json.resize((json.size() + 3) / 4 * 4, ' ');
        return json;
    }

  private:
    static constexpr std::size_t arrays = 5;

    void add_view(std::size_t bytes, const std::string& more) {
        add(views_, fmt::format("{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}{}}}", bytes_, bytes, more));
        bytes_ += (bytes + 3) / 4 * 4;
    }
    void add_views() {
        const std::size_t n = mesh_.position.size();
        for (const std::size_t size : {sizeof(Float3), sizeof(Float3), sizeof(Float2), sizeof(Float2)})
            add_view(n * size, fmt::format(",\"byteStride\":{},\"target\":34962", size));
        add_view(mesh_.index.size() * 4, ",\"target\":34963");
        for (const std::string& texture : textures_) add_view(texture.size(), "");
    }

    std::string primitive_json(const Primitive& p, std::size_t material) {
        constexpr std::array<const char*, 4> names{"POSITION", "NORMAL", "TEXCOORD_0", "TEXCOORD_1"};
        std::string attributes;
        for (std::size_t a = 0; a < names.size(); ++a) {
            const std::size_t size = a < 2 ? sizeof(Float3) : sizeof(Float2);
            std::string accessor =
                fmt::format("{{\"bufferView\":{},\"byteOffset\":{},\"componentType\":5126,\"count\":{},\"type\":\"{}\"",
                            a, p.first_vertex * size, p.vertices, a < 2 ? "VEC3" : "VEC2");
            if (a == 0) accessor += fmt::format(",\"min\":{},\"max\":{}", triple(p.lo), triple(p.hi));
            add(accessors_, accessor + "}");
            add(attributes, fmt::format("\"{}\":{}", names[a], accessor_count_++));
        }
        add(accessors_,
            fmt::format(
                "{{\"bufferView\":4,\"byteOffset\":{},\"componentType\":5125,\"count\":{},\"type\":\"SCALAR\"}}",
                p.first_index * 4, p.indices));
        return fmt::format("{{\"attributes\":{{{}}},\"indices\":{},\"material\":{}}}", attributes, accessor_count_++,
                           material);
    }

    const Scene& scene_;
    const Mesh& mesh_;
    std::span<const std::string> textures_;
    std::string nodes_, scene_nodes_, meshes_, accessors_, views_;
    std::size_t nodes_count_ = 0, accessor_count_ = 0, bytes_ = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> material_of_;
};

}  // namespace

Result<void> write_light_map_glb(const Solution& solution, const LightMaps& light, LightMapMaterial material,
                                 const ToneMap& tone, const std::string& path) {
    const Scene& scene = solution.scene;
    const TextureLevels levels = find_levels(scene, light, material, tone);
    std::vector<std::string> textures;
    for (std::size_t m = 0; m < light.maps.size(); ++m) {
        Result<std::string> png = encode_png(texture(scene, light, m, material, tone, levels.peak), {});
        if (!png) return png.error();
        textures.push_back(std::move(*png));
    }
    const Mesh mesh = make_mesh(scene, light);
    Document document(scene, mesh, textures);
    std::string materials, used;
    for (const auto& [number, map] : document.materials())
        add(materials,
            material_json(scene.materials()[MaterialId(number)], map, material, tone, levels, levels.mean[number]));
    for (const char* extension : {"KHR_materials_unlit", "KHR_materials_emissive_strength", "MOZ_lightmap",
                                  "KHR_materials_specular", "KHR_materials_ior"})
        if (materials.find(fmt::format("\"{}\":", extension)) != std::string::npos)
            add(used, fmt::format("\"{}\"", extension));
    const std::string json = document.text(materials, used, tone, levels);
    std::vector<std::span<const std::byte>> parts{
        std::as_bytes(std::span(mesh.position)), std::as_bytes(std::span(mesh.normal)),
        std::as_bytes(std::span(mesh.plane_place)), std::as_bytes(std::span(mesh.map_place)),
        std::as_bytes(std::span(mesh.index))};
    for (std::string& texture : textures) {
        texture.resize((texture.size() + 3) / 4 * 4);
        parts.push_back(std::as_bytes(std::span(texture)));
    }
    return write_glb_container(path, json, parts, "bake with a smaller --density");
}

}  // namespace exitance
