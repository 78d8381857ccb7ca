#pragma once

#include <string>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// A text between quotation marks, as JSON wants it.
std::string json_text(const std::string& text);

/// What stands in a scene besides surfaces, as parts of a glTF document (JSON without the brackets around it): lights
/// of KHR_lights_punctual and cameras, and a node for each, Y up.
struct GlbNodes {
    std::string nodes, lights, cameras;
    std::size_t count = 0;  ///< Of the nodes.
};
GlbNodes make_light_and_camera_nodes(const Scene& scene);

}  // namespace exitance
