#pragma once

#include <span>
#include <vector>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/visible_part.hpp"

namespace exitance {

/// Returns sensors as receivers of light, at the places found by a PlaceFinder. Sensors on a surface are moved into its
/// plane.
std::vector<SurfacePoint> sensor_places(const Scene& scene, const Occluders& occluders,
                                        std::span<const ProbePoint> sensors);

}  // namespace exitance
