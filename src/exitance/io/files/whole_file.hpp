#pragma once

#include <string>
#include <string_view>

#include "exitance/base/result.hpp"

namespace exitance {

/// The content of a file. Error: cannot_read, with the system's reason.
Result<std::string> read_whole_file(const std::string& path);

/// The path of a file that `name` in the file `path` refers to: relative to the folder of `path`.
std::string beside(const std::string& path, std::string_view name);

/// The same, found even where it was named on another system: with backslashes, by folders that are not here, or with
/// other capitals. As it is named where there is none.
std::string found_beside(const std::string& path, std::string_view name);

/// The ending of a file name in small letters, ".obj", or nothing.
std::string ending(const std::string& path);

}  // namespace exitance
