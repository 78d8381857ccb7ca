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

    /// Calls visit(a, b, c) for the triangles of a polygon, with indices of its corners, counted from its first one.
    template <class Visit>
    void for_triangles(std::size_t polygon, const Visit& visit) const {
        const auto count = static_cast<std::uint32_t>(mesh.corner_count(polygon));
        if (has_middle[polygon])
            for (std::uint32_t c = 0; c + 1 < count; ++c) visit(count - 1, c, (c + 1) % (count - 1));
        else
            for (std::uint32_t c = 2; c < count; ++c) visit(0u, c - 1, c);
    }
};

/// Makes a conforming mesh in three steps. Corners that differ by a few units of single precision are merged. Each edge
/// gets the corners of the region's other polygons that are on it, with interpolated values. Polygons that become
/// degenerate are removed.
/// Corners of other regions are ignored: where two walls meet they may be arbitrarily close, and a triangle between
/// them would have an undefined normal. Expected O(n log n).
ConformingMesh make_conforming(const ElementMesh& mesh);

}  // namespace exitance
