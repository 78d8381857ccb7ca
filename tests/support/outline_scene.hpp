#pragma once

#include <vector>

#include "exitance/scene/add_polygon.hpp"

namespace exitance {

using Outline = std::vector<Point>;  ///< Corners of a face, counter-clockwise seen from its front, metres.

/// Returns a scene of these faces, which have no common corners and reflect a quarter of the light.
inline Scene scene_of(const std::vector<Outline>& outlines) {
    SceneDescription d;
    d.materials.push_back({"grey", Spectrum(0.25), Spectrum()});
    d.groups.push_back("all");
    for (const Outline& outline : outlines) add_polygon(d, outline);
    return *make_scene(d).scene;
}

}  // namespace exitance
