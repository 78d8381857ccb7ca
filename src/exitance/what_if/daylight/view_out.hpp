#pragma once

#include <span>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// The view out of windows from one place, as EN 17037 judges it.
struct ViewOut {
    double sight_angle = 0;  ///< Degrees of the horizon in which something outside is seen at any height.
    double distance = 0;     ///< Of what is seen there at the eye's height, metres along the ground: the median; may be
                             ///< infinite; 0 where nothing outside is seen.
    bool sky = false, landscape = false, ground = false;  ///< Layers in view.
    /// 0 none; 1 (minimum): 14 degrees, 6 m, landscape; 2 (medium): 28 degrees, 20 m, landscape and another layer; 3
    /// (high): 54 degrees, 50 m, all layers.
    int level() const;
};

/// Looks around from each eye (metres), a ray every quarter of a degree and 2.5 degrees of height, from 45 below to 45
/// above. Outside is what lies behind a pane, and what meets nothing. Sky is what meets nothing above the horizon;
/// ground what meets nothing below it, or a face outside that looks up; landscape the horizon itself, or another face
/// outside. About 50 ms an eye.
std::vector<ViewOut> views_out(const Scene& scene, std::span<const Point> eyes);

}  // namespace exitance
