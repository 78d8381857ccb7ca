#pragma once

#include "exitance/lab/local_passes/line_hierarchy.hpp"
#include "exitance/mesh/discontinuity/six_node_mesh.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

struct LocalPassWork {
    std::size_t nodes = 0, form_factors = 0, rays = 0, exact = 0;  ///< Number of nodes, and of computations at them.
    double radius_ratio = 0;
};

/// The local pass of [Lischinski93]: computes irradiance at the nodes of quadratic triangles, from the links of the
/// leaf there and of its ancestors. The triangles are a constrained Delaunay mesh of the hierarchy's leaves and of the
/// discontinuity lines.
///
///   a  the leaf's value; the mean where leaves meet
///   b  form factors recomputed for the node, visibility of the link
///   c  form factors and visibility recomputed
///   d  c for primary sources, b for the rest
///   e  primary sources exactly (DirectLight), b for reflected light
///
/// All rules work on the same hierarchy; `e` omits the emitted light of links. O(nodes x links of a path).
SixNodeMesh run_local_pass(const LineHierarchy& hierarchy, LocalPassRule rule, LocalPassWork& work,
                           const StopRequest& stop);

}  // namespace exitance
