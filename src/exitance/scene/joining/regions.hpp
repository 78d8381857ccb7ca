#pragma once

#include "exitance/scene/joining/face_mesh.hpp"

namespace exitance {

/// Coplanar faces joined along edges: their numbers, ascending, and the border of their union as numbers of points.
struct JoinedFaces {
    std::vector<std::uint32_t> faces;
    /// Outer loops counter-clockwise, holes clockwise; corners where the border goes straight on are left out. Each
    /// loop starts at its lexicographically smallest corner, outer loops come first, loops are ordered by their start.
    std::vector<std::vector<std::uint32_t>> loops;
};

/// Joins faces of one material and one orientation that lie in one plane and share an edge or a part of one. A face
/// that covers a part of an earlier one of its set stays by itself; so do all faces of a union that is no proper
/// polygon for other reasons. Sets are ordered by their first face. How the faces were cut does not show in the result.
/// Expected O(n log n) in edges.
std::vector<JoinedFaces> join_coplanar(const FaceMesh& mesh, const Tolerances& tolerances);

}  // namespace exitance
