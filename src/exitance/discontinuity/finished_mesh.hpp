#pragma once

#include <functional>
#include <span>

#include "exitance/mesh/discontinuity/bisection_mesh.hpp"

namespace exitance {

/// Returns the triangles of a mesh with their six nodes, without the nodes that only test the polynomials.
/// O(triangles).
/// values           irradiance at the nodes, W/m^2
/// region_of_face   region of each face
/// class_of         shadow class of a face, given the centre of one of its triangles; called once per face
SixNodeMesh finished_mesh(const BisectionMesh& mesh, std::span<const Spectrum> values,
                          std::span<const RegionId> region_of_face,
                          const std::function<ShadowClass(std::uint32_t face, const Point& at)>& class_of);

}  // namespace exitance
