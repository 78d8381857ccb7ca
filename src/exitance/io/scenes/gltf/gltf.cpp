// Data read by tinygltf is used only after the checks in this file.
#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/gltf/gltf_accessor.hpp"
#include "exitance/io/scenes/gltf/gltf_model.hpp"
#include "exitance/io/scenes/gltf/gltf_parse.hpp"
#include "exitance/io/scenes/textures/texture_mean.hpp"

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
    void read_materials();
    GltfModel::Colour texture_mean(int texture, const ByteCurve& decode, const std::string& material);
    std::optional<std::span<const std::uint8_t>> view_bytes(int view) const;
    bool rows(int accessor, int type, bool is_index, const std::string& what, GltfRows& out);
    GltfAccessor accessor_of(const tinygltf::Accessor& in) const;
    void read_views_and_lamps();
    void read_places(const tinygltf::Primitive& in, GltfModel::Primitive& out);
    void read_normals(const tinygltf::Primitive& in, GltfModel::Primitive& out);
    void read_colours(const tinygltf::Primitive& in, GltfModel::Primitive& out);
    GltfModel::TextureUse texture_use(int index, int place_set, const tinygltf::ExtensionMap& extensions) const;
    void read_pictures();
    bool read_nodes();
    bool read_node(const tinygltf::Node& in, std::size_t number);

    bool error(std::string message, std::string hint = "") {
        findings_.push_back({Finding::Kind::error, path_, 0, std::move(message), std::move(hint)});
        return false;
    }
    void warn(std::string message, std::string hint = "") {
        findings_.push_back({Finding::Kind::warning, path_, 0, std::move(message), std::move(hint)});
    }
    static std::string name_or(const std::string& name, const char* kind, std::size_t number) {
        return name.empty() ? fmt::format("{} {}", kind, number) : name;
    }
    template <class List>
    static bool names_one(int index, const List& list) {
        return index >= 0 && static_cast<std::size_t>(index) < list.size();
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

/// Returns the bytes of a buffer view; empty if some of them are missing.
std::optional<std::span<const std::uint8_t>> GltfReader::view_bytes(int view) const {
    if (!names_one(view, in_.bufferViews)) return std::nullopt;
    const tinygltf::BufferView& v = in_.bufferViews[static_cast<std::size_t>(view)];
    if (!names_one(v.buffer, in_.buffers)) return std::nullopt;
    const std::vector<unsigned char>& bytes = in_.buffers[static_cast<std::size_t>(v.buffer)].data;
    if (v.byteOffset > bytes.size() || v.byteLength > bytes.size() - v.byteOffset) return std::nullopt;
    return std::span(bytes).subspan(v.byteOffset, v.byteLength);
}

/// Describes an accessor, with the bytes it refers to.
GltfAccessor GltfReader::accessor_of(const tinygltf::Accessor& in) const {
    GltfAccessor a;
    a.component = in.componentType, a.count = in.count, a.normalized = in.normalized;
    a.view = in.bufferView, a.first = in.byteOffset;
    a.bytes = view_bytes(in.bufferView);
    if (a.bytes) a.stride = in_.bufferViews[static_cast<std::size_t>(in.bufferView)].byteStride;
    if (in.sparse.isSparse) {
        const auto& places = in.sparse.indices;
        const auto& values = in.sparse.values;
        a.sparse = GltfAccessor::Sparse{in.sparse.count,
                                        places.componentType,
                                        view_bytes(places.bufferView),
                                        view_bytes(values.bufferView),
                                        static_cast<std::int64_t>(places.byteOffset),
                                        static_cast<std::int64_t>(values.byteOffset)};
    }
    return a;
}

/// Gets the rows of an accessor. Reports an error, in which `what` names the data, and returns false if rows are
/// missing.
bool GltfReader::rows(int accessor, int type, bool is_index, const std::string& what, GltfRows& out) {
    if (!names_one(accessor, in_.accessors))
        return error(fmt::format("{} name accessor {} of {}", what, accessor, in_.accessors.size()));
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
        return error(fmt::format("mesh '{}' has material {} of {}", mesh, in.material, in_.materials.size()));
    p.material = in.material;
    if (with_textures_) read_places(in, p), read_normals(in, p), read_colours(in, p);
    out.primitives.push_back(p);
    return true;
}

double number_in(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key, double otherwise) {
    const auto found = extensions.find(extension);
    if (found == extensions.end() || !found->second.IsObject() || !found->second.Has(key)) return otherwise;
    const tinygltf::Value& value = found->second.Get(key);
    return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

void GltfReader::read_places(const tinygltf::Primitive& in, GltfModel::Primitive& out) {
    for (std::size_t set = 0; set < out.places.size(); ++set) {
        const auto found = in.attributes.find(fmt::format("TEXCOORD_{}", set));
        if (found == in.attributes.end() || !names_one(found->second, in_.accessors)) continue;
        const tinygltf::Accessor& accessor = in_.accessors[static_cast<std::size_t>(found->second)];
        if (accessor.type != TINYGLTF_TYPE_VEC2) continue;
        const Result<GltfRows> held = accessors_->rows(accessor_of(accessor), 2, false, "places");
        if (held && held->size() >= out.positions.size()) out.places[set] = *held;
    }
}

void GltfReader::read_normals(const tinygltf::Primitive& in, GltfModel::Primitive& out) {
    const auto found = in.attributes.find("NORMAL");
    if (found == in.attributes.end() || !names_one(found->second, in_.accessors)) return;
    const tinygltf::Accessor& accessor = in_.accessors[static_cast<std::size_t>(found->second)];
    if (accessor.type != TINYGLTF_TYPE_VEC3) return;
    const Result<GltfRows> held = accessors_->rows(accessor_of(accessor), 3, false, "normals");
    if (held && held->size() >= out.positions.size()) out.normals = *held;
}

/// Reads the colours of vertices. Those of exitance's own exports are light and not paint, and are ignored.
void GltfReader::read_colours(const tinygltf::Primitive& in, GltfModel::Primitive& out) {
    const auto found = in.attributes.find("COLOR_0");
    if (found == in.attributes.end() || in.attributes.contains("_RADIOSITY")) return;
    if (!names_one(found->second, in_.accessors)) return;
    const tinygltf::Accessor& accessor = in_.accessors[static_cast<std::size_t>(found->second)];
    const bool has_alpha = accessor.type == TINYGLTF_TYPE_VEC4;
    if (!has_alpha && accessor.type != TINYGLTF_TYPE_VEC3) return;
    const Result<GltfRows> held = accessors_->rows(accessor_of(accessor), has_alpha ? 4 : 3, false, "colours");
    if (held && held->size() >= out.positions.size()) out.colours = *held;
}

GltfModel::TextureUse GltfReader::texture_use(int index, int place_set,
                                              const tinygltf::ExtensionMap& extensions) const {
    GltfModel::TextureUse out;
    if (!names_one(index, in_.textures) || (place_set != 0 && place_set != 1)) return out;
    const tinygltf::Texture& texture = in_.textures[static_cast<std::size_t>(index)];
    if (!names_one(texture.source, in_.images)) return out;
    out.picture = texture.source, out.place_set = place_set;
    if (names_one(texture.sampler, in_.samplers)) {
        const tinygltf::Sampler& sampler = in_.samplers[static_cast<std::size_t>(texture.sampler)];
        out.wrap_s = sampler.wrapS, out.wrap_t = sampler.wrapT;
    }
    const auto found = extensions.find("KHR_texture_transform");
    if (found == extensions.end() || !found->second.IsObject()) return out;
    const auto pair = [&](const char* key, double otherwise) {
        std::array<double, 2> value{otherwise, otherwise};
        if (!found->second.Has(key) || found->second.Get(key).ArrayLen() != 2) return value;
        for (std::size_t k = 0; k < 2; ++k) {
            const tinygltf::Value& number = found->second.Get(key).Get(k);
            if (number.IsNumber()) value[k] = number.GetNumberAsDouble();
        }
        return value;
    };
    const auto offset = pair("offset", 0), scale = pair("scale", 1);
    const double turn = number_in(extensions, "KHR_texture_transform", "rotation", 0);
    const double c = std::cos(turn), s = std::sin(turn);
    out.transform = {c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]};
    const double set = number_in(extensions, "KHR_texture_transform", "texCoord", out.place_set);
    if (set == 0 || set == 1) out.place_set = static_cast<int>(set);
    return out;
}

/// Collects the pictures: those in buffers are referenced, those in separate files move to the model.
void GltfReader::read_pictures() {
    for (tinygltf::Image& image : in_.images) {
        if (image.bufferView >= 0) {
            out_.pictures.push_back(view_bytes(image.bufferView).value_or(std::span<const std::uint8_t>()));
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

/// Mean colour of a texture; white, with a warning, if it cannot be read.
GltfModel::Colour GltfReader::texture_mean(int texture, const ByteCurve& decode, const std::string& material) {
    const auto unread = [&](const std::string& why) {
        warn(fmt::format("a texture of material '{}' {}: it counts as white", material, why));
        return GltfModel::Colour{1, 1, 1};
    };
    if (texture < 0) return {1, 1, 1};
    if (!names_one(texture, in_.textures)) return unread("is not there");
    const int source = in_.textures[static_cast<std::size_t>(texture)].source;
    if (!names_one(source, in_.images)) return unread("has no picture");
    const tinygltf::Image& image = in_.images[static_cast<std::size_t>(source)];
    std::span<const std::uint8_t> bytes = image.image;
    if (image.bufferView >= 0) {
        const auto held = view_bytes(image.bufferView);
        if (!held) return unread("refers to bytes that the file does not have");
        bytes = *held;
    } else if (bytes.empty()) {
        return unread(fmt::format("('{}') cannot be found or read", shown(image.uri)));
    }
    const Result<std::array<double, 3>> mean = mean_colour(bytes, decode);
    if (!mean) return unread(mean.error().message);
    return {(*mean)[0], (*mean)[1], (*mean)[2]};
}

GltfModel::Colour colour_of(const std::vector<double>& factor, double otherwise) {
    if (factor.size() < 3) return {otherwise, otherwise, otherwise};
    return {factor[0], factor[1], factor[2]};
}

GltfModel::Colour times(const GltfModel::Colour& a, const GltfModel::Colour& b, double s = 1) {
    return {s * a.r * b.r, s * a.g * b.g, s * a.b * b.b};
}

/// Reads the first three numbers of an array of an extension; all are `otherwise` if there is no such array.
GltfModel::Colour colour_in(const tinygltf::Value& extension, const char* key, double otherwise) {
    GltfModel::Colour out{otherwise, otherwise, otherwise};
    if (!extension.Has(key) || extension.Get(key).ArrayLen() < 3) return out;
    double* const channels[3] = {&out.r, &out.g, &out.b};
    for (std::size_t k = 0; k < 3; ++k)
        if (const tinygltf::Value& v = extension.Get(key).Get(k); v.IsNumber()) *channels[k] = v.GetNumberAsDouble();
    return out;
}

/// Reads a texture reference of an extension.
tinygltf::TextureInfo texture_in(const tinygltf::Value& extension, const char* key) {
    tinygltf::TextureInfo out;
    if (!extension.Has(key) || !extension.Get(key).IsObject()) return out;
    const tinygltf::Value& texture = extension.Get(key);
    const auto integer = [&](const char* name, int otherwise) {
        return texture.Has(name) && texture.Get(name).IsNumber() ? texture.Get(name).GetNumberAsInt() : otherwise;
    };
    out.index = integer("index", -1), out.texCoord = integer("texCoord", 0);
    if (texture.Has("extensions") && texture.Get("extensions").IsObject())
        for (const std::string& name : texture.Get("extensions").Keys())
            out.extensions[name] = texture.Get("extensions").Get(name);
    return out;
}

/// The diffuse part of a material: the base colour, of which the metallic share does not reflect diffusely. The diffuse
/// colour of the older KHR_materials_pbrSpecularGlossiness takes precedence.
struct DiffusePart {
    GltfModel::Colour factor;
    tinygltf::TextureInfo texture;
    double metallic = 0;
    int metallic_texture = -1;
};

DiffusePart diffuse_part(const tinygltf::Material& in) {
    const auto older = in.extensions.find("KHR_materials_pbrSpecularGlossiness");
    if (older != in.extensions.end() && older->second.IsObject())
        return {colour_in(older->second, "diffuseFactor", 1), texture_in(older->second, "diffuseTexture")};
    const tinygltf::PbrMetallicRoughness& pbr = in.pbrMetallicRoughness;
    return {colour_of(pbr.baseColorFactor, 1), pbr.baseColorTexture, pbr.metallicFactor,
            pbr.metallicRoughnessTexture.index};
}

void GltfReader::read_materials() {
    for (std::size_t i = 0; i < in_.materials.size(); ++i) {
        const tinygltf::Material& in = in_.materials[i];
        const DiffusePart diffuse = diffuse_part(in);
        GltfModel::Material m;
        m.name = name_or(shown(in.name), "material", i);
        m.base = times(diffuse.factor, texture_mean(diffuse.texture.index, srgb_curve(), m.name));
        m.metallic = diffuse.metallic;
        if (m.metallic > 0)  // metalness is the texture's blue channel
            m.metallic *= texture_mean(diffuse.metallic_texture, linear_curve(), m.name).b;
        const double strength = number_in(in.extensions, "KHR_materials_emissive_strength", "emissiveStrength", 1);
        m.emission = times(colour_of(in.emissiveFactor, 0), {1, 1, 1}, strength);
        if (m.emission.r != 0 || m.emission.g != 0 || m.emission.b != 0)
            m.emission = times(m.emission, texture_mean(in.emissiveTexture.index, srgb_curve(), m.name));
        m.double_sided = in.doubleSided;
        if (with_textures_) {
            const tinygltf::TextureInfo &base = diffuse.texture, &glow = in.emissiveTexture;
            m.base_texture = texture_use(base.index, base.texCoord, base.extensions);
            m.emission_texture = texture_use(glow.index, glow.texCoord, glow.extensions);
        }
        m.transmission = number_in(in.extensions, "KHR_materials_transmission", "transmissionFactor", 0);
        m.diffuse_transmission =
            number_in(in.extensions, "KHR_materials_diffuse_transmission", "diffuseTransmissionFactor", 0);
        // The opacity of the texture is multiplied by that of the base colour.
        const std::vector<double>& factor = in.pbrMetallicRoughness.baseColorFactor;
        const double opacity = factor.size() > 3 ? factor[3] : 1;
        const bool is_mask = in.alphaMode == "MASK" && m.base_texture.picture >= 0 && opacity > 0;
        if (is_mask) m.hole_opacity = in.alphaCutoff / opacity;
        m.transparent = in.alphaMode == "BLEND" || (in.alphaMode == "MASK" && !is_mask && opacity < in.alphaCutoff);
        out_.materials.push_back(std::move(m));
    }
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
            return error(
                fmt::format("node {} ('{}') has child {} of {} nodes", number, node.name, child, in_.nodes.size()));
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
                return error(fmt::format("the scene has node {} of {}", root, in_.nodes.size()));
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
        read_materials();
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
