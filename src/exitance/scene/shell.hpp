#pragma once

#include "exitance/scene/inside_out.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// How the faces of a scene hang together.
struct Shell {
    std::size_t open_edges = 0;         ///< With a face on one side only, and no part of another edge on them.
    double open_length = 0;             ///< Of these, m.
    std::size_t t_joints = 0;           ///< Corners that stand inside another face's edge. They do no harm.
    std::vector<SurfaceId> turned;      ///< Faces whose front is where their neighbours have their backs.
    std::vector<InsideOut> inside_out;  ///< Closed bodies, by the numbers of their faces.
    std::vector<Mark> marks;            ///< Of turned faces, of bodies that are inside out, and of open edges.
};

/// Looks at which edges faces share. A face is turned if it runs along shared edges in the direction of its neighbours,
/// and at most a third of the faces that hang together are like it: which of two halves is wrong nobody knows. Edges
/// where more than two faces meet join nothing. O(n log n) in edges.
Shell inspect_shell(const Scene& scene);

/// The message and the hint about a body that is inside out, with the name of the group of its first face.
Finding finding_of(const InsideOut& body, const std::string& group, Finding::Kind kind);

/// Findings about it: a warning for every group with turned faces, and for every body that is inside out.
std::vector<Finding> findings_of(const Shell& shell, const Scene& scene);

}  // namespace exitance
