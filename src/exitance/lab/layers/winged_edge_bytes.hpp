#pragma once

#include "exitance/mesh/discontinuity/six_node_mesh.hpp"
#include "exitance/solution/layers/light_layer.hpp"

namespace exitance {

/// Size of a winged-edge mesh of these triangles with 32-bit indices and doubles, bytes.
std::size_t winged_edge_bytes(const LayerTriangles& triangles);

/// Memory of a mesh as a winged-edge structure with one value per node, bytes.
std::size_t winged_edge_bytes(const SixNodeMesh& mesh);

}  // namespace exitance
