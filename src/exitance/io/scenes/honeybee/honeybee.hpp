#pragma once

#include <string>

#include "exitance/io/scenes/honeybee/honeybee_choice.hpp"
#include "exitance/io/scenes/obj/obj.hpp"

namespace exitance {

/// Reads a Honeybee model (HBJSON) as a scene. Materials are those that Honeybee would write for Radiance. Walls
/// between rooms show each room its own side; windows between rooms are one pane. A group is an object's identifier.
ReadScene read_honeybee(const std::string& path, const HoneybeeChoices& choices = {});

}  // namespace exitance
