#pragma once

#include <cstddef>
#include <string>

#include "exitance/transport/stage.hpp"

namespace exitance {

/// Describes where a room of the stage is, for messages: "room of 12.3 m^2 between (0, 0, 0) and (4, 3, 2.5) with
/// 'walls', 'floor', 'desk' and 3 more objects", or "surroundings of 'house' and 'shed', 700 m^2 between ...". The box
/// is that of the faces whose centres are in the room. Objects with the largest areas, and the largest bodies, come
/// first. O(faces).
std::string place_of_room(const Stage& stage, std::size_t room);

}  // namespace exitance
