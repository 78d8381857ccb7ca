#pragma once

#include <map>
#include <string>

namespace exitance {

/// The plain values of a JSON object as text, by key; nothing where the text is no JSON object. Keys of objects in it
/// come after a point: "seconds.total".
std::map<std::string, std::string> facts_of_json(const std::string& text);

}  // namespace exitance
