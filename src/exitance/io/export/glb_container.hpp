#pragma once

#include <span>
#include <string>

#include "exitance/base/result.hpp"

namespace exitance {

/// Writes a .glb file: a header, the JSON chunk, and a binary chunk of the concatenated `parts`. The length of `json`,
/// and of all parts together, must be a multiple of 4. `instead` is the hint in the error if the file would exceed 4
/// GiB.
Result<void> write_glb_container(const std::string& path, const std::string& json,
                                 std::span<const std::span<const std::byte>> parts, const std::string& instead);

}  // namespace exitance
