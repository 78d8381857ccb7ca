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
/// - The faces' borders, each run through in its own sense and cut where panes stand across it, and the panes' cancel
///   out, once faces with free edges (furniture, ground, outsides) are left aside: then the rest is a closed surface,
///   and every way from where it winds about to the outside passes it. The face with most in its own border of what is
///   too much goes first; panes stay, turned as the faces ask for, or to where more ways out meet faces.
/// - Of no two panes some of either lies beyond the other, seen from within: what leaves by one comes in by none.
/// - A region is within where the surface winds about all of its triangles, which cross no part of it.
///
/// Corners within a millionth of the scene's size are one. O(n log n) for n corners, about 2 us a corner.
Enclosure find_enclosure(const Scene& scene);

}  // namespace exitance
