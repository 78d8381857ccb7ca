#pragma once

#include <span>
#include <string>
#include <vector>

#include "exitance/transport/stage.hpp"
#include "exitance/visibility/visible_part.hpp"

namespace exitance {

/// Numbers of sensors that are probably misplaced, so that their light is not the intended one.
struct MisplacedSensors {
    /// Sensors from which mostly backs of faces are visible: below a floor, or inside a body.
    std::vector<std::size_t> behind;
    std::vector<std::size_t> outdoors;  ///< Sensors under the open sky, in a model in which other sensors are indoors.
};

/// Finds sensors that see mostly backs of faces, and sensors outdoors if others are indoors. A sensor is outdoors if
/// neither a face nor a pane is straight above it, nor in at least 30% of the directions above it. Casts 64 rays per
/// sensor: 5 us each.
MisplacedSensors find_misplaced(const Stage& stage, std::span<const SurfacePoint> sensors);

/// Returns a sentence for each kind of misplaced sensors, with their count and the first of them.
std::vector<std::string> warnings_of(const MisplacedSensors& misplaced, std::span<const SurfacePoint> sensors);

}  // namespace exitance
