#pragma once

#include <span>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// View out of windows from one point, as assessed by EN 17037.
struct ViewOut {
    double sight_angle = 0;  ///< Horizontal angle in which the outside is seen at any height, degrees.
    /// Median distance to the outside along the ground, seen at eye height (or at any height if it is not seen there),
    /// metres. May be infinite; 0 if the outside is not seen.
    double distance = 0;
    bool sky = false, landscape = false, ground = false;  ///< Layers in view.
    /// Level of the view:
    /// - 0: none,
    /// - 1 (minimum): 14 degrees, 6 m, landscape,
    /// - 2 (medium): 28 degrees, 20 m, landscape and another layer,
    /// - 3 (high): 54 degrees, 50 m, all layers.
    int level() const;
};

/// Casts rays around each eye (metres), every quarter of a degree of azimuth and every 2.5 degrees of altitude, from 45
/// degrees below to 45 above the horizon. A ray sees the outside if it passes a pane or hits nothing. Layers: sky if
/// nothing is hit above the horizon; ground if nothing is hit below it, or an upward face outside is hit; landscape if
/// nothing is hit at the horizon, or another face outside is hit. About 50 ms per eye.
std::vector<ViewOut> views_out(const Scene& scene, std::span<const Point> eyes);

}  // namespace exitance
