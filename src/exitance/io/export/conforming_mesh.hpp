#pragma once

#include "exitance/io/export/element_mesh.hpp"

namespace exitance {

/// A mesh without T-vertices inside regions, for programs that store positions in single precision. Rounding would move
/// a corner on a neighbour's edge off that edge, which opens visible cracks and prevents faces from being merged.
struct ConformingMesh {
    ElementMesh mesh;
    /// Per polygon: true if its last point is its centre, which is to be connected to every edge. This applies to
    /// polygons with corners on straight edges, where triangles between corners alone could have no area.
    std::vector<bool> has_middle;
};

/// Makes a conforming mesh in three steps. Corners that differ by a few units of single precision are merged. Each edge
/// gets the corners of the region's other polygons that are on it, with interpolated values. Polygons that become
/// degenerate are removed.
/// Corners of other regions are ignored: where two walls meet they may be arbitrarily close, and a triangle between
/// them would have an undefined normal. Expected O(n log n).
ConformingMesh make_conforming(const ElementMesh& mesh);

}  // namespace exitance
