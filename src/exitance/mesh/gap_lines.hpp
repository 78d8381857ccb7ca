#pragma once

#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// A line between two strips of a surface on one side of a gap, parallel to the gap's mouth.
struct GapLine {
    Point a, b;         ///< End points, in the plane of the region.
    double height;      ///< Distance between the sides of the gap, metres.
    double depth;       ///< How far all strips together extend into the gap, metres.
    double from_mouth;  ///< Distance of the line from the mouth, metres.
    Vec3 inwards;       ///< Unit vector from the mouth into the gap.
    RegionId region;    ///< Region of the surface.
};

/// Finds the narrow gaps between regions that face each other at a small distance, and the lines that divide both sides
/// of each gap into strips. Light that enters through the mouth of a gap, the border of a region, decays with the
/// distance from the mouth. The scale of this decay is the gap's height, the distance between its sides. The widths of
/// the strips are therefore one, two and four heights. There are fewer strips if they would pass the middle of the gap,
/// since beyond it, light from the opposite mouth dominates.
///
/// faces        a tree over the boxes of the scene's surfaces, by index
/// touching     metres; smaller distances are contacts, not gaps
/// Returns the lines on both sides of every gap, in the order of the borders. O(edges log n), parallel; plus the number
/// of corners of both regions for each edge at which a gap opens.
std::vector<GapLine> find_gap_lines(const Scene& scene, const Bvh& faces, double touching);

}  // namespace exitance
