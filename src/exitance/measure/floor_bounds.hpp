#pragma once

#include <functional>
#include <optional>

#include "exitance/measure/floor_cells.hpp"

namespace exitance {

/// A room below a place.
struct LowerRoom {
    double level = 0;  ///< Height of its floor, metres.
    double area = 0;   ///< m^2
};

/// Returns the room that contains a place above its floor, if it is lower than the examined part.
using FindLowerRoom = std::function<std::optional<LowerRoom>(const Point&)>;

/// True if a part of a floor is the top of a body rather than the floor of a room: a rack, a machine, an air duct. Its
/// outline falls to a lower room, without walls, panes, parapets or railings, and no stairs or ramp lead away from it.
/// This holds if nearly all of the outline falls, unless it is a large slab below which people can stand, such as the
/// storey of a car park. It also holds if only a
/// quarter falls but the body is solid and small beside the lower room, such as a rack at a wall. Larger parts, such as
/// the upper level of a hall, are rooms. Casts some dozens of rays per cell of the outline, and, where other
/// faces are level with it, up to 160,000 rays in search of stairs.
bool is_top_of_body(const Scene& scene, const RayTracer& tracer, const FloorCells& storey, std::uint32_t part,
                    const FindLowerRoom& find_lower_room);

}  // namespace exitance
