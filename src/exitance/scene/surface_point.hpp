#pragma once

#include "exitance/scene/scene.hpp"

namespace exitance {

/// A point of a surface with the direction that it faces: one that receives light, a vertex of a path, a sensor or an
/// eye. Its own region neither shades it nor counts as an occluder.
struct SurfacePoint {
    Point x;          ///< Metres.
    Normal n;         ///< Unit length.
    RegionId region;  ///< The region that contains it; none in free space.
};

/// Start or end of a ray: a point of a region, or of free space if the region is none.
struct RayEnd {
    Point x;  ///< Metres.
    RegionId region;
};

}  // namespace exitance
