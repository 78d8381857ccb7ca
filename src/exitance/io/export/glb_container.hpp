#pragma once

#include <span>
#include <string>

#include "exitance/base/result.hpp"

namespace exitance {

/// Writes a .glb file: a header, the JSON chunk and the binary chunk, which is `parts` one after the other. The lengths
/// of `json` and of all parts together are multiples of 4. `instead` is the hint where they need more than 4 GiB.
Result<void> write_glb_container(const std::string& path, const std::string& json,
                                 std::span<const std::span<const std::byte>> parts, const std::string& instead);

}  // namespace exitance
