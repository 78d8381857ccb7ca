#pragma once

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Two faces of one plane and one orientation that overlap: which of them receives the light would be arbitrary.
struct Overlap {
    SurfaceId first, second;  ///< The first is the one with the smaller id.
    double area;              ///< m^2
};

/// The overlaps of a scene.
struct Overlaps {
    std::vector<Overlap> pairs;  ///< One entry per pair of regions, sorted by ids.
    bool gave_up = false;        ///< True if too many faces overlap and not all were compared.
};

/// Finds faces of different regions that are in one plane within `tolerance` (metres), have the same orientation and
/// overlap by more than rounding. Reports at most four overlaps of a face with faces as large as itself, and for two
/// regions only the two faces that overlap most. Expected O(n log n) in faces.
Overlaps find_overlaps(const Scene& scene, double tolerance);

}  // namespace exitance
