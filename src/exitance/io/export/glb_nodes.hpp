#pragma once

#include <string>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// The lights and cameras of a scene as parts of a glTF document (JSON lists without brackets): KHR_lights_punctual,
/// cameras, and one node for each of these, Y up.
struct GlbNodes {
    std::string nodes, lights, cameras;
    std::size_t count = 0;  ///< Number of nodes.
};
GlbNodes make_light_and_camera_nodes(const Scene& scene);

}  // namespace exitance
