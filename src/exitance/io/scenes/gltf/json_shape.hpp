#pragma once

#include <cstddef>
#include <string_view>

namespace exitance {

/// The bounds of JSON that tinygltf is trusted with: it recurses over nested values, and copies the binary chunk for
/// every buffer without a name of its own.
struct JsonShape {
    std::size_t depth = 0;    ///< Of lists and objects within each other.
    std::size_t buffers = 0;  ///< Objects in lists called "buffers", or more.
};

/// O(bytes), without recursion; of text that is no JSON something harmless.
JsonShape shape_of_json(std::string_view json);

}  // namespace exitance
