#pragma once

#include <functional>
#include <span>

#include "exitance/mesh/discontinuity/bisection_mesh.hpp"

namespace exitance {

/// The triangles of a mesh with their six nodes, those that only tried the polynomials left out. O(triangles).
/// values           of nodes, W/m^2      region_of_face   of faces
/// class_of         how a face is lit, at a place of it; once a face
SixNodeMesh finished_mesh(const BisectionMesh& mesh, std::span<const Spectrum> values,
                          std::span<const RegionId> region_of_face,
                          const std::function<ShadowClass(std::uint32_t face, const Point& at)>& class_of);

}  // namespace exitance
