#pragma once

#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// A line between two strips of a surface that is one side of a gap, along the gap's mouth.
struct GapLine {
    Point a, b;       ///< In the plane of the region.
    double height;    ///< Of the gap, metres.
    double depth;     ///< How far into the gap all its strips reach, metres.
    RegionId region;  ///< Whose surface it is.
};

/// Gaps open along the borders of regions that look at each other from nearby. Light that enters falls off with the
/// distance from the mouth by the height, so that strips twice as wide as those before them follow it: one height, two,
/// and four; until next to nothing is left, or less than a strip up to the middle of the gap: there light enters from
/// the other side, too.
///
/// faces        a tree of the boxes of the scene's surfaces, by number
/// touching     metres; what is nearer than this is no gap
/// Returns the lines on both sides of every gap, in the order of the borders. O(edges log n), parallel; the corners of
/// both regions more for each edge that a gap opens at.
std::vector<GapLine> find_gap_lines(const Scene& scene, const Bvh& faces, double touching);

}  // namespace exitance
