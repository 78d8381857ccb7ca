#pragma once

#include <optional>
#include <vector>

#include "exitance/measure/floor_rooms.hpp"
#include "exitance/measure/glare/glare.hpp"

namespace exitance {

constexpr double observer_clearance = 0.25;  ///< Metres; derived from the space that a head and a body take.
constexpr double seated_eye_height = 1.2;    ///< Height of the eyes of a seated person, metres [EN12464].

/// Observers of CIE 117 in every room: seated (eyes 1.2 m above the floor, or at half of the height of a low room), in
/// the middle of each side, looking across the room. Where a wall or an object is within `observer_clearance`, it is
/// placed at the nearest free place; a side without one has no observer. Casts some dozens of rays per place.
std::vector<Observer> room_observers(const Stage& stage, const FloorRooms& rooms);

}  // namespace exitance
