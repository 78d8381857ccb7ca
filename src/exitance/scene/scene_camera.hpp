#pragma once

#include <string>

#include "exitance/base/vec.hpp"

namespace exitance {

/// A view that came with a scene, for pictures.
struct SceneCamera {
    std::string name;
    Point eye, target;    ///< Metres.
    Vec3 up = {0, 0, 1};  ///< Upward direction in the picture; unit vector, not parallel to the view.
    double fov = 60;      ///< Angle from the left to the right edge, degrees, in (0, 180).
    double width = 0;     ///< Width of an orthographic view, metres; 0 for a perspective one.
};

}  // namespace exitance
