#pragma once

#include <tiny_gltf.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exitance/io/scenes/gltf/gltf_model.hpp"

namespace exitance {

/// True if an index names an entry of a list.
template <class List>
bool names_one(int index, const List& list) {
    return index >= 0 && static_cast<std::size_t>(index) < list.size();
}

/// Returns a name, or a kind and a number such as "mesh 3" if the name is empty.
std::string name_or(const std::string& name, const char* kind, std::size_t number);

/// Returns the bytes of a buffer view; empty if some of them are missing.
std::optional<std::span<const std::uint8_t>> view_bytes(const tinygltf::Model& model, int view);

/// Returns a number of an extension, or `otherwise`.
double number_in(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key, double otherwise);

/// Returns the first three numbers of a list as a colour; all are `otherwise` if there are fewer.
GltfModel::Colour colour_of(const std::vector<double>& factor, double otherwise);

/// Returns s a b.
GltfModel::Colour times(const GltfModel::Colour& a, const GltfModel::Colour& b, double s = 1);

}  // namespace exitance
