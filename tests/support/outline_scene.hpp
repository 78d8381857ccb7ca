#pragma once

#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

using Outline = std::vector<Point>;  ///< Corners of a face, counter-clockwise seen from its front, metres.

/// Returns a scene of these faces, which have no common corners and reflect a quarter of the light.
inline Scene scene_of(const std::vector<Outline>& outlines) {
    SceneDescription d;
    d.materials.push_back({"grey", Spectrum(0.25), Spectrum()});
    d.groups.push_back("all");
    for (const Outline& outline : outlines) {
        SceneDescription::Face face;
        for (const Point& p : outline) {
            face.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            d.points.push_back(p);
        }
        d.faces.push_back(face);
    }
    return *make_scene(d).scene;
}

}  // namespace exitance
