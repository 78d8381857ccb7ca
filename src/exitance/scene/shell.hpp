#pragma once

#include "exitance/scene/scene.hpp"

namespace exitance {

/// How the faces of a scene hang together.
struct Shell {
    std::size_t open_edges = 0;     ///< With a face on one side only, and no part of another edge on them.
    double open_length = 0;         ///< Of these, m.
    std::size_t t_joints = 0;       ///< Corners that stand inside another face's edge. They do no harm.
    std::vector<SurfaceId> turned;  ///< Faces whose front is where their neighbours have their backs.
    std::vector<Mark> marks;        ///< Of turned faces and open edges.
};

/// Looks at which edges faces share. A face is turned if it runs along shared edges in the direction of its neighbours,
/// and at most a third of the faces that hang together are like it: which of two halves is wrong nobody knows. Edges
/// where more than two faces meet join nothing. O(n log n) in edges.
Shell inspect_shell(const Scene& scene);

/// Findings about it: a warning for every group with turned faces.
std::vector<Finding> findings_of(const Shell& shell, const Scene& scene);

}  // namespace exitance
