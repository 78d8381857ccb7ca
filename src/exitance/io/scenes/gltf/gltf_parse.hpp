#pragma once

#include <optional>
#include <string>

#include "exitance/base/result.hpp"

namespace tinygltf {
class Model;
}

namespace exitance {

/// glTF's JSON, or the binary container of it, with the buffers and pictures beside the file, as tinygltf reads them:
/// `out` says what the file says, which may be anything. Returns why the file is refused, if it is.
std::optional<Error> parse_gltf(const std::string& bytes, const std::string& path, tinygltf::Model& out);

}  // namespace exitance
