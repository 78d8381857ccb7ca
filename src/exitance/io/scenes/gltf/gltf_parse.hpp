#pragma once

#include <optional>
#include <string>

#include "exitance/base/result.hpp"

namespace tinygltf {
class Model;
}

namespace exitance {

/// Parses glTF's JSON or binary container and reads the buffers and pictures in separate files, with tinygltf. The
/// content of `out` is unchecked. Returns an error if the file cannot be parsed.
std::optional<Error> parse_gltf(const std::string& bytes, const std::string& path, tinygltf::Model& out);

}  // namespace exitance
