#pragma once

#include <utility>
#include <vector>

#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Finds the walls without thickness whose two sides have different outlines or materials, such as the ceiling of a
/// room and the floor of a smaller one above. They are pairs of regions that overlap in one plane, have opposite
/// normals, and see open space in front of them. Where a body stands on a floor, two such regions touch instead, and
/// hide each other: rays from the floor then meet the backs of the body's faces. The largest common part of two regions
/// decides for all of them. Pairs are sorted, the smaller id first. O(n log n) in the faces of planes that have faces
/// of both orientations if few of them overlap, and at most 54 rays per pair.
std::vector<std::pair<RegionId, RegionId>> find_thin_walls(const Occluders& occluders, const RayTracer& tracer);

}  // namespace exitance
