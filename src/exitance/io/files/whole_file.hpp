#pragma once

#include <string>
#include <string_view>

#include "exitance/base/result.hpp"

namespace exitance {

/// Returns the content of a file. Error: cannot_read, with the system's reason.
Result<std::string> read_whole_file(const std::string& path);

/// Returns the path of a file that the file `path` refers to as `name`, relative to the folder of `path`.
std::string beside(const std::string& path, std::string_view name);

/// Like beside(), but also finds files whose names were written on another system: with backslashes, with folders that
/// do not exist here, or with different capitals. Returns beside(path, name) if there is no such file.
std::string found_beside(const std::string& path, std::string_view name);

/// True if both paths lead to the same existing file.
bool is_same_file(const std::string& a, const std::string& b);

/// Returns the ending of a file name in small letters, such as ".obj"; may be empty.
std::string ending(const std::string& path);

}  // namespace exitance
