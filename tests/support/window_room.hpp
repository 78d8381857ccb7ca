#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "exitance/scene/add_polygon.hpp"
#include "exitance/scene/scene_builder.hpp"
#include "exitance/scene/sky/sun_position.hpp"

namespace exitance::test {

/// A room of 4 x 3 x 2.5 m with a glass window of 2 x 1 m in the wall y = 3, under a sky.
struct WindowRoom {
    SceneDescription d;

    WindowRoom() {
        d.file = "room.obj";
        d.materials = {{"grey", Spectrum(0.5), {}}};
        d.groups = {"all"};
        face({{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}});
        face({{0, 0, 2.5}, {0, 3, 2.5}, {4, 3, 2.5}, {4, 0, 2.5}});
        face({{0, 0, 0}, {0, 0, 2.5}, {4, 0, 2.5}, {4, 0, 0}});
        face({{0, 0, 0}, {0, 3, 0}, {0, 3, 2.5}, {0, 0, 2.5}});
        face({{4, 0, 0}, {4, 0, 2.5}, {4, 3, 2.5}, {4, 3, 0}});
        face({{0, 3, 0}, {4, 3, 0}, {4, 3, 1}, {3, 3, 1}, {1, 3, 1}, {0, 3, 1}});
        face({{0, 3, 2}, {1, 3, 2}, {3, 3, 2}, {4, 3, 2}, {4, 3, 2.5}, {0, 3, 2.5}});
        face({{0, 3, 1}, {1, 3, 1}, {1, 3, 2}, {0, 3, 2}});
        face({{3, 3, 1}, {4, 3, 1}, {4, 3, 2}, {3, 3, 2}});
        Pane pane;
        pane.corners = {{1, 3, 1}, {3, 3, 1}, {3, 3, 2}, {1, 3, 2}};
        for (std::size_t b = 0; b < bands; ++b) pane.transmissivity[b] = 0.9 - 0.2 * static_cast<double>(b);
        d.panes = {pane};
        d.distant.domes.push_back({perez_sky({100, 300, 80}, sky_direction(40, 10)), Spectrum(100.0)});
        DistantLight::Dome ground{uniform_sky(), Spectrum(20.0)};
        ground.model.below = true;
        d.distant.domes.push_back(ground);
    }
    void face(const std::vector<Point>& corners) { add_polygon(d, corners); }
    /// Moves the pane `depth` behind the inner wall. The reveals extend `beyond` farther and are split at the pane if
    /// `cut`.
    void set_back(double depth, double beyond, bool cut) {
        for (Point& p : d.panes[0].corners) p.y = 3 + depth;
        if (cut) reveals(3, 3 + depth), reveals(3 + depth, 3 + depth + beyond);
        if (!cut) reveals(3, 3 + depth + beyond);
    }
    void reveals(double from, double to) {
        if (!(to > from)) return;
        face({{1, from, 1}, {3, from, 1}, {3, to, 1}, {1, to, 1}});
        face({{1, from, 2}, {1, to, 2}, {3, to, 2}, {3, from, 2}});
        face({{1, from, 1}, {1, to, 1}, {1, to, 2}, {1, from, 2}});
        face({{3, from, 1}, {3, from, 2}, {3, to, 2}, {3, to, 1}});
    }
    /// Adds outer walls, floor and roof around the room, at a distance of `thick`, with the window's opening.
    void shell(double thick) {
        const double a = -thick, x = 4 + thick, y = 3 + thick, z = 2.5 + thick;
        face({{a, a, a}, {a, y, a}, {x, y, a}, {x, a, a}});
        face({{a, a, z}, {x, a, z}, {x, y, z}, {a, y, z}});
        face({{a, a, a}, {x, a, a}, {x, a, z}, {a, a, z}});
        face({{a, a, a}, {a, a, z}, {a, y, z}, {a, y, a}});
        face({{x, a, a}, {x, y, a}, {x, y, z}, {x, a, z}});
        face({{a, y, a}, {a, y, 1}, {1, y, 1}, {3, y, 1}, {x, y, 1}, {x, y, a}});
        face({{a, y, 2}, {a, y, z}, {x, y, z}, {x, y, 2}, {3, y, 2}, {1, y, 2}});
        face({{a, y, 1}, {a, y, 2}, {1, y, 2}, {1, y, 1}});
        face({{3, y, 1}, {3, y, 2}, {x, y, 2}, {x, y, 1}});
    }
    /// Adds a lawn and a house across the street.
    void outdoors() {
        face({{-20, 3.4, -0.5}, {20, 3.4, -0.5}, {20, 30, -0.5}, {-20, 30, -0.5}});
        face({{1, 9, -0.5}, {8, 9, -0.5}, {8, 9, 4}, {1, 9, 4}});
    }
    Scene scene() const {
        CheckedScene checked = make_scene(SceneDescription(d));
        EXI_CHECK(static_cast<bool>(checked.scene));
        return std::move(*checked.scene);
    }
};

/// Adds a pane of clear glass that is darker in one band than in the others.
inline void add_pane(WindowRoom& room, std::vector<Point> corners) {
    Pane pane;
    pane.corners = std::move(corners);
    for (std::size_t b = 0; b < bands; ++b) pane.transmissivity[b] = 0.5 + 0.2 * static_cast<double>(b);
    room.d.panes.push_back(pane);
}

/// Adds a second room of the same size at x > 4 without a window. The wall between has a pane of 1 x 1.5 m.
inline void add_room_behind_a_pane(WindowRoom& room) {
    room.d.faces.erase(room.d.faces.begin() + 4);  // the wall at x = 4
    const std::size_t first = room.d.faces.size();
    room.face({{4, 0, 0}, {4, 3, 0}, {4, 3, 0.5}, {4, 0, 0.5}});
    room.face({{4, 0, 2}, {4, 3, 2}, {4, 3, 2.5}, {4, 0, 2.5}});
    room.face({{4, 0, 0.5}, {4, 1, 0.5}, {4, 1, 2}, {4, 0, 2}});
    room.face({{4, 2, 0.5}, {4, 3, 0.5}, {4, 3, 2}, {4, 2, 2}});
    for (std::size_t i = first, end = room.d.faces.size(); i < end; ++i) {
        SceneDescription::Face back = room.d.faces[i];
        std::reverse(back.corners.begin(), back.corners.end());
        room.d.faces.push_back(std::move(back));
    }
    room.face({{4, 0, 0}, {8, 0, 0}, {8, 3, 0}, {4, 3, 0}});
    room.face({{4, 0, 2.5}, {4, 3, 2.5}, {8, 3, 2.5}, {8, 0, 2.5}});
    room.face({{4, 0, 0}, {4, 0, 2.5}, {8, 0, 2.5}, {8, 0, 0}});
    room.face({{4, 3, 0}, {8, 3, 0}, {8, 3, 2.5}, {4, 3, 2.5}});
    room.face({{8, 0, 0}, {8, 0, 2.5}, {8, 3, 2.5}, {8, 3, 0}});
    add_pane(room, {{4, 1, 0.5}, {4, 2, 0.5}, {4, 2, 2}, {4, 1, 2}});
}

/// Adds a box of glass over a block that stands free in the room.
inline void add_glass_case(WindowRoom& room) {
    const Point lo{1, 1, 0.5}, hi{2, 2, 1.5};
    add_pane(room, {{lo.x, lo.y, lo.z}, {lo.x, hi.y, lo.z}, {hi.x, hi.y, lo.z}, {hi.x, lo.y, lo.z}});
    add_pane(room, {{lo.x, lo.y, hi.z}, {hi.x, lo.y, hi.z}, {hi.x, hi.y, hi.z}, {lo.x, hi.y, hi.z}});
    add_pane(room, {{lo.x, lo.y, lo.z}, {hi.x, lo.y, lo.z}, {hi.x, lo.y, hi.z}, {lo.x, lo.y, hi.z}});
    add_pane(room, {{hi.x, hi.y, lo.z}, {lo.x, hi.y, lo.z}, {lo.x, hi.y, hi.z}, {hi.x, hi.y, hi.z}});
    add_pane(room, {{lo.x, hi.y, lo.z}, {lo.x, lo.y, lo.z}, {lo.x, lo.y, hi.z}, {lo.x, hi.y, hi.z}});
    add_pane(room, {{hi.x, lo.y, lo.z}, {hi.x, hi.y, lo.z}, {hi.x, hi.y, hi.z}, {hi.x, lo.y, hi.z}});
    room.face({{1.2, 1.2, 0.7}, {1.8, 1.2, 0.7}, {1.8, 1.8, 0.7}, {1.2, 1.8, 0.7}});
}

/// A case of panes besides the window, and the number of them.
struct MorePanes {
    const char* name;
    std::size_t others;
    void (*add)(WindowRoom&);
};
inline const MorePanes more_panes[] = {
    {"between two rooms", 1, add_room_behind_a_pane},
    {"a table", 1,
     [](WindowRoom& room) {
         add_pane(room, {{1, 1, 0.7}, {3, 1, 0.7}, {3, 2, 0.7}, {1, 2, 0.7}});
     }},
    {"an oblique pane", 1,
     [](WindowRoom& room) {
         add_pane(room, {{0.5, 1, 0.2}, {3.5, 2, 0.2}, {3.5, 2.3, 2.2}, {0.5, 1.3, 2.2}});
     }},
    {"a second pane in front", 1,
     [](WindowRoom& room) {
         add_pane(room, {{1, 3.02, 1}, {3, 3.02, 1}, {3, 3.02, 2}, {1, 3.02, 2}});
     }},
    {"a railing outdoors", 1,
     [](WindowRoom& room) {
         add_pane(room, {{0, 4, 0}, {4, 4.8, 0}, {4, 4.8, 1.6}, {0, 4, 1.6}});
     }},
    {"a glass case", 6, add_glass_case},
    {"two panes in a reveal", 1,
     [](WindowRoom& room) {
         room.reveals(3, 3.02);
         add_pane(room, {{1, 3.02, 1}, {3, 3.02, 1}, {3, 3.02, 2}, {1, 3.02, 2}});
     }},
};

}  // namespace exitance::test
