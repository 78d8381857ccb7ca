#pragma once

#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Closed surfaces of faces and glass panes, and the regions inside them. From inside, the sky is visible only through
/// windows, through one at a time. Faces outside in front of a window may hide it (`looks_out_on_faces`).
struct Enclosure {
    std::vector<Pane> windows;  ///< Panes between inside and outside, corners counter-clockwise seen from inside.
    /// All other panes: between two rooms, within a room, outdoors. Light through a window may pass any number of them.
    std::vector<Pane> others;
    Field<RegionId, std::uint8_t> is_within;  ///< 1 if the whole front side of the region is inside.

    bool empty() const { return windows.empty(); }
    bool holds(RegionId r) const { return !windows.empty() && !r.is_none() && is_within[r] != 0; }
};

/// Finds the enclosure of a scene. A pane is a window if the space at one of its sides is bounded and that at the other
/// is not:
///
/// - The sides reached from a pane's inner side (`Borders::sides_reached_from`) do not include its outer side. The
/// faces of which only one side is reached form a closed surface; furniture, partitions, panes between two rooms and
/// other attached faces are reached on both sides. Every path from inside this surface to the outside crosses it.
/// - That surface does not wind about the outer side, as it does for a glass box that stands in a room.
///
/// The result is empty if the scene has no windows or no sky, if the sides of a pane cannot be told, or if two windows
/// are partly behind each other, seen from inside: a path that leaves through one may then enter through another.
///
/// A region is inside if the surface winds about all of its triangles and crosses none of them.
///
/// Corners within a millionth of the scene's size are treated as equal. O(n log n) for n corners, about 2 us per
/// corner.
Enclosure find_enclosure(const Scene& scene);

}  // namespace exitance
