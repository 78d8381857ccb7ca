#pragma once

#include <string>
#include <utility>
#include <vector>

namespace exitance {

/// Splits text at blanks; words in single or double quotes may contain blanks.
std::vector<std::string> split_words(const std::string& text);
/// Replaces "{name}" in `text` for all names.
std::string filled_in(std::string text, const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace exitance
