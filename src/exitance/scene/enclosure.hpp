#pragma once

#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Closed surfaces of faces and glass panes, and the regions inside them. From inside, the sky is visible only through
/// panes, through one at a time. Faces outside in front of a pane may hide it (`looks_out_on_faces`).
struct Enclosure {
    std::vector<Pane> windows;                ///< The scene's panes, corners counter-clockwise seen from inside.
    Field<RegionId, std::uint8_t> is_within;  ///< 1 if the whole front side of the region is inside.

    bool empty() const { return windows.empty(); }
    bool holds(RegionId r) const { return !windows.empty() && !r.is_none() && is_within[r] != 0; }
};

/// Finds the enclosure of a scene. The result is empty if the scene has no panes or no sky, or unless all of the
/// following is certain:
///
/// - The sides reached from a pane's inner side (`Borders::sides_reached_from`) do not include its outer side. The
/// faces of which only one side is reached form a closed surface; furniture, partitions and other attached faces are
/// reached on both sides. Every path from inside this surface to the outside crosses it. The space at the pane's inner
/// side is bounded, that at its outer side is not.
/// - No two panes are partly behind each other, seen from inside: a path that leaves through one cannot enter through
/// another.
///
/// A region is inside if the surface winds about all of its triangles and crosses none of them.
///
/// Corners within a millionth of the scene's size are treated as equal. O(n log n) for n corners, about 2 us per
/// corner.
Enclosure find_enclosure(const Scene& scene);

}  // namespace exitance
