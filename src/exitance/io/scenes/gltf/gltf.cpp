// Data read by tinygltf is used only after the checks in this file and in gltf_materials.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/gltf/gltf_accessor.hpp"
#include "exitance/io/scenes/gltf/gltf_materials.hpp"
#include "exitance/io/scenes/gltf/gltf_parse.hpp"
#include "exitance/io/scenes/gltf/gltf_values.hpp"

namespace exitance {
namespace {

constexpr std::array known_extensions = {"KHR_lights_punctual",
                                         "KHR_materials_emissive_strength",
                                         "KHR_texture_transform",
                                         "KHR_mesh_quantization",
                                         "KHR_materials_unlit",
                                         "KHR_materials_ior",
                                         "KHR_materials_specular",
                                         "KHR_materials_clearcoat",
                                         "KHR_materials_sheen",
                                         "KHR_materials_iridescence",
                                         "KHR_materials_anisotropy",
                                         "KHR_materials_variants",
                                         "KHR_materials_dispersion",
                                         "KHR_materials_pbrSpecularGlossiness",
                                         "KHR_materials_transmission",
                                         "KHR_materials_volume",
                                         "KHR_materials_diffuse_transmission"};

class GltfReader {
  public:
    GltfReader(const std::string& path, std::vector<Finding>& findings, bool with_textures)
        : path_(path), findings_(findings), with_textures_(with_textures) {}
    Result<GltfModel> read();

  private:
    bool check_extensions();
    bool read_meshes();
    bool read_primitive(const tinygltf::Primitive& in, const std::string& mesh, GltfModel::Mesh& out);
    bool rows(int accessor, int type, bool is_index, const std::string& what, GltfRows& out);
    GltfAccessor accessor_of(const tinygltf::Accessor& in) const;
    void read_views_and_lamps();
    GltfRows vertex_rows(const tinygltf::Primitive& in, const std::string& attribute, std::initializer_list<int> types,
                         std::size_t vertices);
    void read_attributes(const tinygltf::Primitive& in, GltfModel::Primitive& out);
    void read_pictures();
    bool read_nodes();
    bool read_node(const tinygltf::Node& in, std::size_t number);

    bool error(std::string message, std::string hint = "") {
        findings_.push_back({Finding::Kind::error, path_, 0, std::move(message), std::move(hint)});
        return false;
    }

    const std::string& path_;
    std::vector<Finding>& findings_;
    bool with_textures_;
    tinygltf::Model in_;
    GltfModel out_;
    std::optional<GltfAccessorCheck> accessors_;
};

bool GltfReader::check_extensions() {
    for (const std::string& name : in_.extensionsRequired)
        if (std::find(known_extensions.begin(), known_extensions.end(), name) == known_extensions.end())
            return error(fmt::format("needs the extension '{}', which is not supported", shown(name)),
                         "export it again without this extension (switch off compression and instancing)");
    return true;
}

/// Describes an accessor, with the bytes it refers to.
GltfAccessor GltfReader::accessor_of(const tinygltf::Accessor& in) const {
    GltfAccessor a;
    a.component = in.componentType, a.count = in.count, a.normalized = in.normalized;
    a.view = in.bufferView, a.first = in.byteOffset;
    a.bytes = view_bytes(in_, in.bufferView);
    if (a.bytes) a.stride = in_.bufferViews[static_cast<std::size_t>(in.bufferView)].byteStride;
    if (in.sparse.isSparse) {
        const auto& places = in.sparse.indices;
        const auto& values = in.sparse.values;
        a.sparse = GltfAccessor::Sparse{in.sparse.count,
                                        places.componentType,
                                        view_bytes(in_, places.bufferView),
                                        view_bytes(in_, values.bufferView),
                                        static_cast<std::int64_t>(places.byteOffset),
                                        static_cast<std::int64_t>(values.byteOffset)};
    }
    return a;
}

/// Gets the rows of an accessor. Reports an error, in which `what` names the data, and returns false if rows are
/// missing.
bool GltfReader::rows(int accessor, int type, bool is_index, const std::string& what, GltfRows& out) {
    if (!names_one(accessor, in_.accessors))
        return error(fmt::format("{} refer to accessor {}, but there are {}", what, accessor, in_.accessors.size()));
    const tinygltf::Accessor& in = in_.accessors[static_cast<std::size_t>(accessor)];
    if (in.type != type) return error(fmt::format("{} do not have the expected type", what));
    const Result<GltfRows> held = accessors_->rows(accessor_of(in), is_index ? 1 : 3, is_index, what);
    if (!held) return error(held.error().message);
    out = *held;
    return true;
}

bool GltfReader::read_primitive(const tinygltf::Primitive& in, const std::string& mesh, GltfModel::Mesh& out) {
    GltfModel::Primitive p;
    switch (in.mode) {
        case TINYGLTF_MODE_POINTS:
        case TINYGLTF_MODE_LINE:
        case TINYGLTF_MODE_LINE_LOOP:
        case TINYGLTF_MODE_LINE_STRIP:
            return true;  // points and lines have no area
        case TINYGLTF_MODE_TRIANGLE_STRIP:
            p.mode = GltfModel::Mode::strip;
            break;
        case TINYGLTF_MODE_TRIANGLE_FAN:
            p.mode = GltfModel::Mode::fan;
            break;
        case -1:
        case TINYGLTF_MODE_TRIANGLES:
            break;
        default:
            return error(fmt::format("mesh '{}' has the drawing mode {}, which does not exist", mesh, in.mode));
    }
    for (const auto& [name, value] : in.extensions)
        if (name == "KHR_draco_mesh_compression")
            return error(fmt::format("mesh '{}' is compressed (Draco), which is not supported", mesh),
                         "export it again without compression");
    const auto position = in.attributes.find("POSITION");
    if (position == in.attributes.end()) return true;  // the specification requires readers to skip such primitives
    p.accessor = position->second;
    if (!rows(p.accessor, TINYGLTF_TYPE_VEC3, false, fmt::format("positions of mesh '{}'", mesh), p.positions))
        return false;
    p.has_indices = in.indices >= 0;
    if (p.has_indices &&
        !rows(in.indices, TINYGLTF_TYPE_SCALAR, true, fmt::format("indices of mesh '{}'", mesh), p.indices))
        return false;
    if (in.material >= 0 && !names_one(in.material, in_.materials))
        return error(
            fmt::format("mesh '{}' refers to material {}, but there are {}", mesh, in.material, in_.materials.size()));
    p.material = in.material;
    if (with_textures_) read_attributes(in, p);
    out.primitives.push_back(p);
    return true;
}

/// Returns the rows of an attribute of vertices. They are empty if the file does not have the attribute, if it has none
/// of these types, and if there are fewer rows than vertices.
GltfRows GltfReader::vertex_rows(const tinygltf::Primitive& in, const std::string& attribute,
                                 std::initializer_list<int> types, std::size_t vertices) {
    const auto found = in.attributes.find(attribute);
    if (found == in.attributes.end() || !names_one(found->second, in_.accessors)) return {};
    const tinygltf::Accessor& accessor = in_.accessors[static_cast<std::size_t>(found->second)];
    if (std::find(types.begin(), types.end(), accessor.type) == types.end()) return {};
    const auto width = static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<unsigned>(accessor.type)));
    const Result<GltfRows> held = accessors_->rows(accessor_of(accessor), width, false, attribute);
    return held && held->size() >= vertices ? *held : GltfRows();
}

/// Reads texture coordinates, normals and colours of vertices. Colours of exitance's own exports are light and not
/// paint, and are ignored.
void GltfReader::read_attributes(const tinygltf::Primitive& in, GltfModel::Primitive& out) {
    const std::size_t vertices = out.positions.size();
    for (std::size_t set = 0; set < out.places.size(); ++set)
        out.places[set] = vertex_rows(in, fmt::format("TEXCOORD_{}", set), {TINYGLTF_TYPE_VEC2}, vertices);
    out.normals = vertex_rows(in, "NORMAL", {TINYGLTF_TYPE_VEC3}, vertices);
    if (!in.attributes.contains("_RADIOSITY"))
        out.colours = vertex_rows(in, "COLOR_0", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4}, vertices);
}

/// Collects the pictures: those in buffers are referenced, those in separate files move to the model.
void GltfReader::read_pictures() {
    for (tinygltf::Image& image : in_.images) {
        if (image.bufferView >= 0) {
            out_.pictures.push_back(view_bytes(in_, image.bufferView).value_or(std::span<const std::uint8_t>()));
            continue;
        }
        out_.bytes.push_back(std::move(image.image));
        out_.pictures.push_back(out_.bytes.back());
    }
}

bool GltfReader::read_meshes() {
    for (std::size_t i = 0; i < in_.meshes.size(); ++i) {
        GltfModel::Mesh mesh{name_or(shown(in_.meshes[i].name), "mesh", i), {}};
        for (const tinygltf::Primitive& primitive : in_.meshes[i].primitives)
            if (!read_primitive(primitive, mesh.name, mesh)) return false;
        out_.meshes.push_back(std::move(mesh));
    }
    return true;
}

void GltfReader::read_views_and_lamps() {
    for (std::size_t i = 0; i < in_.cameras.size(); ++i) {
        const tinygltf::Camera& in = in_.cameras[i];
        GltfModel::View view{name_or(shown(in.name), "camera", i), in.perspective.yfov, in.perspective.aspectRatio, 0};
        if (in.type == "orthographic") view.xmag = std::abs(in.orthographic.xmag);
        out_.views.push_back(std::move(view));
    }
    for (std::size_t i = 0; i < in_.lights.size(); ++i) {
        const tinygltf::Light& in = in_.lights[i];
        GltfModel::Lamp lamp;
        lamp.name = name_or(shown(in.name), "light", i);
        lamp.kind = in.type == "spot"          ? PunctualLight::Kind::spot
                    : in.type == "directional" ? PunctualLight::Kind::directional
                                               : PunctualLight::Kind::point;
        lamp.intensity = times(colour_of(in.color, 1), {1, 1, 1}, in.intensity);
        if (lamp.kind == PunctualLight::Kind::spot)
            lamp.inner_cone = in.spot.innerConeAngle, lamp.outer_cone = in.spot.outerConeAngle;
        lamp.has_range = in.range > 0;
        out_.lamps.push_back(std::move(lamp));
    }
}

bool GltfReader::read_node(const tinygltf::Node& in, std::size_t number) {
    GltfModel::Node node;
    node.name = shown(in.name);
    const std::optional<Affine> transform = gltf_transform(in.matrix, in.rotation, in.scale, in.translation);
    if (!transform) return error(fmt::format("node {} ('{}') has an invalid transform", number, node.name));
    node.to_parent = *transform;
    const double lamp = number_in(in.extensions, "KHR_lights_punctual", "light", -1);
    if ((in.mesh >= 0 && !names_one(in.mesh, out_.meshes)) || (in.camera >= 0 && !names_one(in.camera, out_.views)) ||
        !(lamp < static_cast<double>(out_.lamps.size())))
        return error(
            fmt::format("node {} ('{}') names a mesh, camera or light that does not exist", number, node.name));
    node.mesh = in.mesh, node.view = in.camera, node.lamp = lamp < 0 ? -1 : static_cast<int>(lamp);
    node.is_deformed = in.skin >= 0 || !in.weights.empty();
    for (const int child : in.children) {
        if (!names_one(child, in_.nodes))
            return error(fmt::format("node {} ('{}') has node {} as child, but there are {} nodes", number, node.name,
                                     child, in_.nodes.size()));
        node.children.push_back(child);
    }
    if (in.extensions.count("EXT_mesh_gpu_instancing") > 0)
        return error(
            fmt::format("node {} ('{}') has instances in a buffer, which are not supported", number, node.name),
            "export it again with one node per instance");
    out_.nodes.push_back(std::move(node));
    return true;
}

bool GltfReader::read_nodes() {
    for (std::size_t i = 0; i < in_.nodes.size(); ++i)
        if (!read_node(in_.nodes[i], i)) return false;
    if (!in_.scenes.empty()) {
        const int scene = names_one(in_.defaultScene, in_.scenes) ? in_.defaultScene : 0;
        for (const int root : in_.scenes[static_cast<std::size_t>(scene)].nodes) {
            if (!names_one(root, in_.nodes))
                return error(fmt::format("the scene refers to node {}, but there are {}", root, in_.nodes.size()));
            out_.roots.push_back(root);
        }
        return true;
    }
    std::vector<bool> is_child(in_.nodes.size());
    for (const GltfModel::Node& node : out_.nodes)
        for (const int child : node.children) is_child[static_cast<std::size_t>(child)] = true;
    for (std::size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i]) out_.roots.push_back(static_cast<int>(i));
    return !out_.roots.empty() || in_.nodes.empty() ||
           error("every node is the child of another: the scene has no root node");
}

Result<GltfModel> GltfReader::read() {
    std::uint64_t file_bytes = 0;
    {
        const Result<std::string> bytes = read_whole_file(path_);
        if (!bytes) return bytes.error();
        file_bytes = bytes->size();
        if (std::optional<Error> refused = parse_gltf(*bytes, path_, in_)) return std::move(*refused);
    }
    for (const tinygltf::Buffer& buffer : in_.buffers)
        file_bytes = std::max<std::uint64_t>(file_bytes, buffer.data.size());
    accessors_.emplace(file_bytes, out_.bytes);
    read_views_and_lamps();
    if (check_extensions() && read_meshes()) {
        out_.materials = read_gltf_materials(in_, path_, findings_, with_textures_);
        read_nodes();
        if (with_textures_) read_pictures();
    }
    for (tinygltf::Buffer& buffer : in_.buffers) out_.bytes.push_back(std::move(buffer.data));
    return std::move(out_);
}

}  // namespace

Result<GltfModel> load_gltf_model(const std::string& path, std::vector<Finding>& findings, bool with_textures) {
    return GltfReader(path, findings, with_textures).read();
}

}  // namespace exitance
