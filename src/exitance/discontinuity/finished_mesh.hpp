#pragma once

#include <span>

#include "exitance/mesh/discontinuity/bisection_mesh.hpp"

namespace exitance {

/// Returns the triangles of a mesh with their six nodes, without the nodes that only test the polynomials,
/// in the same order. Shadow classes are left empty. O(triangles).
/// values           irradiance at the nodes, W/m^2
/// region_of_face   region of each face
SixNodeMesh finished_mesh(const BisectionMesh& mesh, std::span<const Spectrum> values,
                          std::span<const RegionId> region_of_face);

}  // namespace exitance
