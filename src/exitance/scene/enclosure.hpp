#pragma once

#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Closed surfaces of faces and panes of glass, and what lies within: from there the sky is seen through panes alone,
/// through one at a time. Faces that stand behind a pane may hide it from there (`looks_out_on_faces`).
struct Enclosure {
    std::vector<Pane> windows;                ///< The scene's panes, their corners counter-clockwise seen from within.
    Field<RegionId, std::uint8_t> is_within;  ///< All of a region, in front of it.

    bool empty() const { return windows.empty(); }
    bool holds(RegionId r) const { return !windows.empty() && !r.is_none() && is_within[r] != 0; }
};

/// Empty where the scene has no panes or no sky, or where one of these cannot be made sure of:
///
/// - Who walks on a pane's inner side and steps over edges, cut where corners lie on them, onto the side that faces him
///   there, over free ones onto the back, never comes to its outer side. The faces of which he comes by one side are a
///   closed surface; furniture, partitions and what else hangs on it have both. Every way from where it winds about to
///   the outside passes it. The space before the inner side has an end, that before the outer one has none.
/// - Of no two panes some of either lies beyond the other, seen from within: what leaves by one comes in by none.
/// - A region is within where the surface winds about all of its triangles, which cross no part of it.
///
/// Corners within a millionth of the scene's size are one. O(n log n) for n corners, about 2 us a corner.
Enclosure find_enclosure(const Scene& scene);

}  // namespace exitance
