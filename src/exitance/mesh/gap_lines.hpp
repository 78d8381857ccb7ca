#pragma once

#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// A line between two strips of a surface on one side of a gap, parallel to the gap's mouth.
struct GapLine {
    Point a, b;       ///< End points, in the plane of the region.
    double height;    ///< Distance between the sides of the gap, metres.
    double depth;     ///< How far all strips together extend into the gap, metres.
    RegionId region;  ///< Region of the surface.
};

/// Finds gaps, which open at the borders of regions that face each other at a small distance. Light that enters decays
/// with the distance from the mouth, on the scale of the gap's height. Each strip is twice as wide as the one before:
/// one height, two, and four. Strips end when almost no light is left, or when the next one would not fit before the
/// middle of the gap, beyond which light enters from the other side, too.
///
/// faces        a tree over the boxes of the scene's surfaces, by index
/// touching     metres; smaller distances are contacts, not gaps
/// Returns the lines on both sides of every gap, in the order of the borders. O(edges log n), parallel; plus the number
/// of corners of both regions for each edge at which a gap opens.
std::vector<GapLine> find_gap_lines(const Scene& scene, const Bvh& faces, double touching);

}  // namespace exitance
