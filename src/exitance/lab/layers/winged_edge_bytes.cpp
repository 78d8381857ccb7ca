#include "exitance/lab/layers/winged_edge_bytes.hpp"

#include <algorithm>

#include "exitance/lab/dm_tree/winged_edge_mesh.hpp"

namespace exitance {

std::size_t winged_edge_bytes(const LayerTriangles& triangles) {
    return triangles.points.size() * sizeof(WingedEdgeMesh::Vertex) +
           triangles.edge_count() * sizeof(WingedEdgeMesh::Edge) +
           triangles.corners.size() * sizeof(WingedEdgeMesh::Face);
}

std::size_t winged_edge_bytes(const SixNodeMesh& mesh) {
    std::vector<bool> is_corner(mesh.points.size()), is_middle(mesh.points.size());
    for (const auto& n : mesh.nodes)
        for (std::size_t k = 0; k < 3; ++k) is_corner[n[k]] = is_middle[n[3 + k]] = true;
    const auto count = [](const std::vector<bool>& of) {
        return static_cast<std::size_t>(std::count(of.begin(), of.end(), true));
    };
    return count(is_corner) * sizeof(WingedEdgeMesh::Vertex) + count(is_middle) * sizeof(WingedEdgeMesh::Edge) +
           mesh.size() * sizeof(WingedEdgeMesh::Face);
}

}  // namespace exitance
