#pragma once

#include <string>

#include "exitance/base/result.hpp"

namespace exitance {

/// Error for a file or folder that cannot be written. `error` is an errno, which decides the hint.
Error cannot_write(const std::string& path, int error);

/// Makes a folder and those above it, unless they exist.
Result<void> make_folder(const std::string& path);

}  // namespace exitance
