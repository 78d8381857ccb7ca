#pragma once

#include <functional>

#include "exitance/measure/floor_cells.hpp"

namespace exitance {

/// Returns true if a place above the floor is in a lower room.
using InLowerRoom = std::function<bool(const Point&)>;

/// True if a part of a floor is the top of a body rather than the floor of a room: a rack, a machine, an air duct. Its
/// outline falls to a lower room, without walls, panes, parapets or railings, and no stairs or ramp lead away from it.
/// The top of a body that people can stand beneath (a mezzanine) is one only if nearly all of its outline falls; that
/// of a solid body, such as a rack beside a wall, already if a quarter does.
/// `rise`: height above that room's floor, metres. Casts some dozens of rays per cell of the outline.
bool is_top_of_body(const Scene& scene, const RayTracer& tracer, const FloorCells& storey, std::uint32_t part,
                    double rise, const InLowerRoom& in_lower_room);

}  // namespace exitance
