#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace exitance {

/// Numbers of the states in which a scene shows dynamic objects of a Honeybee model, by the identifiers of the objects.
/// Other objects are in their first state.
using HoneybeeChoices = std::map<std::string, std::size_t>;

}  // namespace exitance
