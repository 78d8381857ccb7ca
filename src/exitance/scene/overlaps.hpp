#pragma once

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Two faces of one plane and one orientation that cover a common area: which of them light meets is left to chance.
struct Overlap {
    SurfaceId first, second;  ///< The first is the one with the smaller id.
    double area;              ///< m^2
};

/// What was found of a scene.
struct Overlaps {
    std::vector<Overlap> pairs;  ///< One of each two regions, ordered by ids.
    bool gave_up = false;        ///< So many faces lie over one another that not all were compared.
};

/// Finds faces of different regions that lie in one plane within `tolerance` (metres), look the same way and overlap by
/// more than rounding. Of a face that covers more than four as large as itself, four are told; of two regions, the two
/// faces that overlap most. Expected O(n log n) in faces.
Overlaps find_overlaps(const Scene& scene, double tolerance);

}  // namespace exitance
