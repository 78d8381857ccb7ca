#pragma once

#include <array>
#include <span>
#include <string>

#include "exitance/base/result.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

using Float3 = std::array<float, 3>;

/// Converts Z up to glTF's Y up.
inline Float3 y_up(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.z), static_cast<float>(-v.y)};
}

/// Writes a .glb file: a header, the JSON chunk, and a binary chunk of the concatenated `parts`. The length of `json`,
/// and of all parts together, must be a multiple of 4. `instead` is the hint in the error if the file would exceed 4
/// GiB.
Result<void> write_glb_container(const std::string& path, const std::string& json,
                                 std::span<const std::span<const std::byte>> parts, const std::string& instead);

}  // namespace exitance
