#pragma once

#include <functional>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Adds a face with points of its own, which no other face shares, at `place(corner)` for each corner. Returns the
/// face, whose material, group and line are 0; the reference is valid until another face is added.
template <class Place = std::identity>
SceneDescription::Face& add_polygon(SceneDescription& d, const std::vector<Point>& corners, const Place& place = {}) {
    SceneDescription::Face& face = d.faces.emplace_back();
    for (const Point& p : corners) {
        face.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
        d.points.push_back(place(p));
    }
    return face;
}

}  // namespace exitance
