#include "exitance/io/scenes/gltf/gltf_materials.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/scenes/gltf/gltf_values.hpp"
#include "exitance/io/scenes/textures/texture_mean.hpp"

namespace exitance {
namespace {

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

class GltfMaterials {
  public:
    GltfMaterials(const tinygltf::Model& in, const std::string& path, std::vector<Finding>& findings,
                  bool with_textures)
        : in_(in), path_(path), findings_(findings), with_textures_(with_textures) {}

    GltfModel::Material read(const tinygltf::Material& in, std::size_t number);

  private:
    GltfModel::Colour texture_mean(int texture, const ByteCurve& decode, const std::string& material);
    GltfModel::TextureUse texture_use(int index, int place_set, const tinygltf::ExtensionMap& extensions) const;

    const tinygltf::Model& in_;
    const std::string& path_;
    std::vector<Finding>& findings_;
    bool with_textures_;
};

/// Returns the mean colour of a texture; white, with a warning, if it cannot be read.
GltfModel::Colour GltfMaterials::texture_mean(int texture, const ByteCurve& decode, const std::string& material) {
    const auto unread = [&](const std::string& why) {
        findings_.push_back({Finding::Kind::warning, path_, 0,
                             fmt::format("a texture of material '{}' {}: it counts as white", material, why), ""});
        return GltfModel::Colour{1, 1, 1};
    };
    if (texture < 0) return {1, 1, 1};
    if (!names_one(texture, in_.textures)) return unread("is not there");
    const int source = in_.textures[static_cast<std::size_t>(texture)].source;
    if (!names_one(source, in_.images)) return unread("has no picture");
    const tinygltf::Image& image = in_.images[static_cast<std::size_t>(source)];
    std::span<const std::uint8_t> bytes = image.image;
    if (image.bufferView >= 0) {
        const auto held = view_bytes(in_, image.bufferView);
        if (!held) return unread("refers to bytes that the file does not have");
        bytes = *held;
    } else if (bytes.empty()) {
        return unread(fmt::format("('{}') cannot be found or read", shown(image.uri)));
    }
    const Result<std::array<double, 3>> mean = mean_colour(bytes, decode);
    if (!mean) return unread(mean.error().message);
    return {(*mean)[0], (*mean)[1], (*mean)[2]};
}

GltfModel::TextureUse GltfMaterials::texture_use(int index, int place_set,
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

GltfModel::Material GltfMaterials::read(const tinygltf::Material& in, std::size_t number) {
    const DiffusePart diffuse = diffuse_part(in);
    GltfModel::Material m;
    m.name = name_or(shown(in.name), "material", number);
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
    return m;
}

}  // namespace

std::vector<GltfModel::Material> read_gltf_materials(const tinygltf::Model& model, const std::string& path,
                                                     std::vector<Finding>& findings, bool with_textures) {
    GltfMaterials reader(model, path, findings, with_textures);
    std::vector<GltfModel::Material> out;
    for (std::size_t i = 0; i < model.materials.size(); ++i) out.push_back(reader.read(model.materials[i], i));
    return out;
}

}  // namespace exitance
