#pragma once

#include "exitance/io/export/element_mesh.hpp"

namespace exitance {

/// A mesh without T-vertices within a region, for programs that hold places in single precision: there a corner that
/// stands on a neighbour's edge no longer lies on it, and a crack opens that shows as sparks and keeps faces from being
/// joined again.
struct ConformingMesh {
    ElementMesh mesh;
    /// Per polygon: is its last point not a corner but its middle, to be joined to every edge? So it is where corners
    /// lie on straight edges: triangles between such corners alone would have no area.
    std::vector<bool> has_middle;
};

/// Corners nearer than a few roundings of single precision become one place, every polygon gets the corners of others
/// of its region that stand on its edges (with values between those of the edge's ends), and polygons that shrink to
/// less than a triangle go. Corners of other regions stay out: where two walls meet they come as close to each other as
/// they like, and the triangle between two such has no direction. Expected O(n log n).
ConformingMesh make_conforming(const ElementMesh& mesh);

}  // namespace exitance
