#pragma once

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Two faces of one plane and one orientation that cover a common area: which of them light meets is left to chance.
struct Overlap {
    SurfaceId first, second;  ///< The first is the one with the smaller id.
    double area;              ///< m^2
};

/// Finds faces of different regions that lie in one plane within `tolerance` (metres), look the same way and overlap by
/// more than rounding. Each pair of regions is reported once, by the pair of faces that overlaps most; ordered by ids.
/// Expected O(n log n) in regions when few share a plane and a place.
std::vector<Overlap> find_overlaps(const Scene& scene, double tolerance);

}  // namespace exitance
