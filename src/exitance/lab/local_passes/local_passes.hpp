#pragma once

#include "exitance/lab/local_passes/line_hierarchy.hpp"
#include "exitance/mesh/discontinuity/six_node_mesh.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

struct LocalPassWork {
    std::size_t nodes = 0, form_factors = 0, rays = 0, exact = 0;  ///< Places, and what was done at them.
    double radius_ratio = 0;
};

/// The local pass of [Lischinski93]: irradiance at the nodes of quadratic triangles, which are a constrained Delaunay
/// mesh of the hierarchy's leaves and of the discontinuity lines, from the links of the leaf there and its ancestors.
///
///   a  the leaf's value; the mean where leaves meet
///   b  form factors anew from the node, visibility as the link has it
///   c  both anew
///   d  c for primary sources, b for the rest
///   e  primary sources exactly (DirectLight), b for what is reflected
///
/// O(nodes x links of a path). Every rule works on the same hierarchy; `e` leaves out what primary sources emit.
SixNodeMesh run_local_pass(const LineHierarchy& hierarchy, LocalPassRule rule, LocalPassWork& work,
                           const StopRequest& stop);

}  // namespace exitance
