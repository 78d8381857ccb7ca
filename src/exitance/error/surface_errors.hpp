#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/ids.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// Error of radiosity at one point of a surface.
struct PointError {
    SurfaceId surface;
    double weight = 0;  ///< Weight of the point in the mean over all surfaces.
    /// Unbiased estimate of the squared error relative to the light of the point's room; may be negative due to noise.
    double squared = 0;
};

/// Returns the RMS error of every surface. A surface with fewer than eight points gets the error of its room.
/// of_rooms  relative error of each surface's room; one entry per surface
std::vector<FaceError> surface_errors(std::span<const PointError> points, std::span<const double> of_rooms);

}  // namespace exitance
