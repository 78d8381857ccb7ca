#pragma once

#include <string>
#include <vector>

#include "exitance/io/scenes/gltf/gltf_model.hpp"

namespace tinygltf {
class Model;
}

namespace exitance {

/// Reads the materials of a parsed file. Textures count with their mean colours; one that cannot be read counts as
/// white, with a warning. With `with_textures`, materials also refer to their pictures.
///
/// path      file that findings name
/// findings  gets the warnings
std::vector<GltfModel::Material> read_gltf_materials(const tinygltf::Model& model, const std::string& path,
                                                     std::vector<Finding>& findings, bool with_textures);

}  // namespace exitance
