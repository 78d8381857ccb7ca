#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/ids.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// The error of radiosity at one point of a surface.
struct PointError {
    SurfaceId surface;
    double weight = 0;   ///< The point's share in the mean over all surfaces.
    double squared = 0;  ///< An unbiased estimate of its square, by the square of its room's light: noise may make it
                         ///< negative.
};

/// RMS errors of surfaces. One of fewer than eight points, too few for a figure of its own, has that of its room.
/// of_rooms  the relative error of each surface's room, one a surface
std::vector<FaceError> surface_errors(std::span<const PointError> points, std::span<const double> of_rooms);

}  // namespace exitance
