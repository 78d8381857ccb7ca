#include "exitance/io/scenes/gltf/gltf_values.hpp"

#include <fmt/format.h>

namespace exitance {

std::string name_or(const std::string& name, const char* kind, std::size_t number) {
    return name.empty() ? fmt::format("{} {}", kind, number) : name;
}

std::optional<std::span<const std::uint8_t>> view_bytes(const tinygltf::Model& model, int view) {
    if (!names_one(view, model.bufferViews)) return std::nullopt;
    const tinygltf::BufferView& v = model.bufferViews[static_cast<std::size_t>(view)];
    if (!names_one(v.buffer, model.buffers)) return std::nullopt;
    const std::vector<unsigned char>& bytes = model.buffers[static_cast<std::size_t>(v.buffer)].data;
    if (v.byteOffset > bytes.size() || v.byteLength > bytes.size() - v.byteOffset) return std::nullopt;
    return std::span(bytes).subspan(v.byteOffset, v.byteLength);
}

double number_in(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key, double otherwise) {
    const auto found = extensions.find(extension);
    if (found == extensions.end() || !found->second.IsObject() || !found->second.Has(key)) return otherwise;
    const tinygltf::Value& value = found->second.Get(key);
    return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

GltfModel::Colour colour_of(const std::vector<double>& factor, double otherwise) {
    if (factor.size() < 3) return {otherwise, otherwise, otherwise};
    return {factor[0], factor[1], factor[2]};
}

GltfModel::Colour times(const GltfModel::Colour& a, const GltfModel::Colour& b, double s) {
    return {s * a.r * b.r, s * a.g * b.g, s * a.b * b.b};
}

}  // namespace exitance
