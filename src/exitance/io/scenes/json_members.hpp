#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "exitance/base/vec.hpp"

namespace exitance {

using Json = nlohmann::json;

/// Returns a member of an object; a null value if there is none of this name.
const Json& member(const Json& object, const char* key);

/// Returns a member that is a list; an empty list if there is none.
const Json& entries(const Json& object, const char* key);

/// Returns the text of a value; empty if it is not a text.
std::string text_of(const Json& value);
std::string text_in(const Json& object, const char* key);

/// True if a member is true.
bool flag_in(const Json& object, const char* key);

/// Returns the vector of a list of three finite numbers; empty for other values.
std::optional<Vec3> vector_of(const Json& value);

}  // namespace exitance
