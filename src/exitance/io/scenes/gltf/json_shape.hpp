#pragma once

#include <cstddef>
#include <string_view>

namespace exitance {

/// Properties of a JSON text that are limited before tinygltf parses it: tinygltf recurses over nested values and
/// copies the binary chunk for every buffer without a URI.
struct JsonShape {
    std::size_t depth = 0;    ///< Nesting depth of lists and objects.
    std::size_t buffers = 0;  ///< Upper bound of the number of objects in lists named "buffers".
};

/// Computes the shape in O(bytes), without recursion. Text that is not JSON gives an arbitrary, harmless result.
JsonShape shape_of_json(std::string_view json);

}  // namespace exitance
