#pragma once

#include <map>
#include <string>

namespace exitance {

/// Returns the plain values of a JSON object as text, by key; nothing if the text is not a JSON object. Keys of nested
/// objects are joined by a dot: "seconds.total".
std::map<std::string, std::string> facts_of_json(const std::string& text);

}  // namespace exitance
