#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>

#include "exitance/base/version.hpp"
#include "exitance/base/words.hpp"
#include "exitance/io/export/conforming_mesh.hpp"
#include "exitance/io/export/export_formats.hpp"
#include "exitance/io/export/glb_container.hpp"
#include "exitance/io/export/glb_nodes.hpp"
#include "exitance/io/pictures/tone_map.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {
namespace {

/// Polygons of one group and material.
struct Primitive {
    std::size_t group = 0, material = 0;
    GlbPart part;
};

/// Arrays of the binary chunk, and their division into primitives.
struct Triangles {
    std::vector<Float3> position, normal, radiosity, irradiance, colour;
    std::vector<std::uint32_t> index;  ///< Relative to the first vertex of the primitive.
    std::vector<Primitive> primitives;
};

Triangles make_triangles(const Solution& solution, const ToneMap& tone) {
    const ConformingMesh conforming = make_conforming(make_element_mesh(solution));
    const ElementMesh& mesh = conforming.mesh;
    std::vector<std::size_t> order(mesh.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    const auto key = [&](std::size_t i) { return std::pair(mesh.group[i], mesh.material[i]); };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });

    Triangles out;
    for (std::size_t k = 0; k < order.size(); ++k) {
        const std::size_t i = order[k];
        if (k == 0 || key(i) != key(order[k - 1]))
            out.primitives.push_back({static_cast<std::size_t>(mesh.group[i]),
                                      static_cast<std::size_t>(mesh.material[i]),
                                      {.first_vertex = out.position.size(), .first_index = out.index.size()}});
        GlbPart& part = out.primitives.back().part;
        const Normal& n = solution.scene.regions()[RegionId(static_cast<std::size_t>(mesh.region[i]))].plane.n;
        conforming.for_triangles(i, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            for (const std::uint32_t corner : {a, b, c})
                out.index.push_back(static_cast<std::uint32_t>(part.vertices) + corner);
        });
        for (std::uint32_t p = mesh.first_point[i]; p < mesh.first_point[i + 1]; ++p) {
            Spectrum light;
            Float3 radiosity, irradiance;
            for (std::size_t b = 0; b < bands; ++b) light[b] = static_cast<double>(mesh.irradiance[p][b]);
            for (std::size_t b = 0; b < 3; ++b) {
                // the bands that the tone map also uses for red, green and blue
                const std::size_t band = bands == 3 ? b : b * (bands - 1) / 2;
                radiosity[b] = mesh.radiosity[p][band], irradiance[b] = mesh.irradiance[p][band];
            }
            const DisplayColour colour = tone(light);
            out.position.push_back(y_up(mesh.points[p]));
            out.normal.push_back(y_up(n));
            out.radiosity.push_back(radiosity);
            out.irradiance.push_back(irradiance);
            out.colour.push_back(
                {static_cast<float>(colour[0]), static_cast<float>(colour[1]), static_cast<float>(colour[2])});
            part.include(out.position.back());
        }
        part.vertices = out.position.size() - part.first_vertex;
        part.indices = out.index.size() - part.first_index;
    }
    return out;
}

std::string material_json(const Material& material) {
    std::array<double, 3> rho = red_green_blue(material.reflectance),
                          radiance = red_green_blue(radiance_of_exitance(material.exitance));
    const std::string out = fmt::format(
        "{{\"name\":{},\"pbrMetallicRoughness\":{{\"baseColorFactor\":[{},{},{},1],"
        "\"metallicFactor\":0,\"roughnessFactor\":1}}",
        json_text(material.name), rho[0], rho[1], rho[2]);
    if (!material.emits()) return out + ",\"extensions\":{\"KHR_materials_unlit\":{}}}";
    const double strength = std::max({radiance[0], radiance[1], radiance[2], 1e-30});
    for (double& value : radiance) value /= strength;
    return fmt::format(
        "{},\"emissiveFactor\":{},\"extensions\":{{\"KHR_materials_emissive_strength\":{{\"emissiveStrength\":{}}}}}}}",
        out, json_triple(radiance), strength);
}

/// Order of the binary chunk: five vertex arrays of the same length, then the indices.
constexpr const char* attribute_names[] = {"POSITION", "NORMAL", "_RADIOSITY", "_IRRADIANCE", "COLOR_0"};
constexpr std::size_t attributes = std::size(attribute_names);

/// JSON lists of a document, without brackets.
struct Lists {
    std::string nodes, meshes, accessors;
    std::size_t node_count = 0, accessor_count = 0;

    std::size_t add_accessor(const std::string& item) {
        add_item(accessors, item);
        return accessor_count++;
    }
};

std::string primitive_json(const Primitive& p, Lists& lists) {
    std::string names;
    for (std::size_t a = 0; a < attributes; ++a) {
        const std::string accessor = vertex_accessor(p.part, a, sizeof(Float3), "VEC3", a == 0);
        add_item(names, fmt::format("\"{}\":{}", attribute_names[a], lists.add_accessor(accessor)));
    }
    const std::size_t indices = lists.add_accessor(index_accessor(p.part, attributes));
    return fmt::format("{{\"attributes\":{{{}}},\"indices\":{},\"material\":{}}}", names, indices, p.material);
}

/// Adds one node and one mesh per group, with one primitive per material.
void add_groups(const Scene& scene, std::span<const Primitive> primitives, Lists& lists) {
    for (std::size_t first = 0, last = 0; first < primitives.size(); first = last) {
        std::string items;
        for (; last < primitives.size() && primitives[last].group == primitives[first].group; ++last)
            add_item(items, primitive_json(primitives[last], lists));
        const std::string name = json_text(scene.groups()[GroupId(primitives[first].group)]);
        add_item(lists.nodes, fmt::format("{{\"mesh\":{},\"name\":{}}}", lists.node_count++, name));
        add_item(lists.meshes, fmt::format("{{\"name\":{},\"primitives\":[{}]}}", name, items));
    }
}

std::string extensions_json(const Scene& scene, const GlbNodes& placed) {
    bool unlit = false, emits = false;
    for (const Material& m : scene.materials()) (m.emits() ? emits : unlit) = true;
    std::string used;
    if (unlit) add_item(used, "\"KHR_materials_unlit\"");
    if (emits) add_item(used, "\"KHR_materials_emissive_strength\"");
    if (placed.lights.empty()) return fmt::format("\"extensionsUsed\":[{}],", used);
    add_item(used, "\"KHR_lights_punctual\"");
    return fmt::format("\"extensionsUsed\":[{}],\"extensions\":{{\"KHR_lights_punctual\":{{\"lights\":[{}]}}}},", used,
                       placed.lights);
}

std::string make_json(const Scene& scene, const Triangles& triangles, const ToneMap& tone) {
    const GlbNodes placed = make_light_and_camera_nodes(scene);
    Lists lists;
    add_groups(scene, triangles.primitives, lists);
    if (placed.count > 0) add_item(lists.nodes, placed.nodes);
    std::string scene_nodes, materials, views;
    for (std::size_t i = 0; i < lists.node_count + placed.count; ++i) add_item(scene_nodes, std::to_string(i));
    for (const Material& m : scene.materials()) add_item(materials, material_json(m));
    const std::size_t array_bytes = triangles.position.size() * sizeof(Float3),
                      index_bytes = triangles.index.size() * 4;
    for (std::size_t a = 0; a < attributes; ++a)
        add_item(views,
                 fmt::format("{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{},\"byteStride\":12,\"target\":34962}}",
                             a * array_bytes, array_bytes));
    add_item(views, fmt::format("{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{},\"target\":34963}}",
                                attributes * array_bytes, index_bytes));
    const LightUnit unit = own_unit(scene.is_photometric());
    std::string json = fmt::format(
        "{{\"asset\":{{\"version\":\"2.0\",\"generator\":\"exitance {}\",\"extras\":{{\"lightUnit\":\"{}\","
        "\"radianceUnit\":\"{}\",\"exposure\":{},\"white\":{}}}}},{}\"scene\":0,\"scenes\":[{{\"nodes\":[{}]}}],"
        "\"nodes\":[{}],\"meshes\":[{}],\"materials\":[{}],\"accessors\":[{}],\"bufferViews\":[{}],{}"
        "\"buffers\":[{{\"byteLength\":{}}}]}}",
        program_version, unit.radiosity(), unit.radiance(), tone.scale, tone.white, extensions_json(scene, placed),
        scene_nodes, lists.nodes, lists.meshes, materials, lists.accessors, views,
        placed.cameras.empty() ? "" : fmt::format("\"cameras\":[{}],", placed.cameras),
        attributes * array_bytes + index_bytes);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    return json;
}

}  // namespace

Result<void> write_glb(const Solution& solution, const std::string& path) {
    const ToneMap tone = make_tone_map(solution);
    const Triangles triangles = make_triangles(solution, tone);
    const std::string json = make_json(solution.scene, triangles, tone);
    std::vector<std::span<const std::byte>> parts;
    for (const auto* array :
         {&triangles.position, &triangles.normal, &triangles.radiosity, &triangles.irradiance, &triangles.colour})
        parts.push_back(std::as_bytes(std::span(*array)));
    parts.push_back(std::as_bytes(std::span(triangles.index)));
    return write_glb_container(path, json, parts, "export .vtkhdf, or solve with a larger --error");
}

}  // namespace exitance
