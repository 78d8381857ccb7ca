#pragma once

#include "exitance/scene/add_polygon.hpp"

namespace exitance {

/// Adds a room of 3 x 4 x 2.5 m whose wall at y = 0 has an opening from z = 1 to 2; the floor is the first face.
inline void add_daylight_room(SceneDescription& d) {
    add_polygon(d, {{0, 0, 0}, {3, 0, 0}, {3, 4, 0}, {0, 4, 0}});
    add_polygon(d, {{0, 0, 2.5}, {0, 4, 2.5}, {3, 4, 2.5}, {3, 0, 2.5}});
    add_polygon(d, {{0, 4, 0}, {3, 4, 0}, {3, 4, 2.5}, {0, 4, 2.5}});
    add_polygon(d, {{0, 0, 0}, {0, 4, 0}, {0, 4, 2.5}, {0, 0, 2.5}});
    add_polygon(d, {{3, 0, 0}, {3, 0, 2.5}, {3, 4, 2.5}, {3, 4, 0}});
    add_polygon(d, {{0, 0, 0}, {0, 0, 1}, {3, 0, 1}, {3, 0, 0}});
    add_polygon(d, {{0, 0, 2}, {0, 0, 2.5}, {3, 0, 2.5}, {3, 0, 2}});
}

}  // namespace exitance
