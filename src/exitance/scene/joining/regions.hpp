#pragma once

#include "exitance/scene/joining/face_mesh.hpp"

namespace exitance {

/// Coplanar faces that were joined along edges: their numbers, ascending, and the border of their union as point
/// numbers.
struct JoinedFaces {
    std::vector<std::uint32_t> faces;
    /// Outer loops counter-clockwise, holes clockwise, without corners on straight parts of the border. Each loop
    /// starts at its lexicographically smallest corner. Outer loops come first; loops are ordered by their first
    /// corner.
    std::vector<std::vector<std::uint32_t>> loops;
};

/// Joins faces of one material and one orientation that are in one plane and share an edge or a part of one. A face
/// that covers a part of an earlier face of its set stays single, and so do all faces of a union that is not a valid
/// polygon for other reasons. Sets are ordered by their first face. The result does not depend on how a polygon was
/// split into faces. Expected O(n log n) in edges.
std::vector<JoinedFaces> join_coplanar(const FaceMesh& mesh, const Tolerances& tolerances);

}  // namespace exitance
