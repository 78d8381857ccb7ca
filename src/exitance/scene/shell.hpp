#pragma once

#include "exitance/scene/inside_out.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Connectivity and orientation of the faces of a scene.
struct Shell {
    std::size_t open_edges = 0;         ///< Edges that belong to only one face and overlap no other edge.
    double open_length = 0;             ///< Total length of the open edges, metres.
    std::vector<SurfaceId> turned;      ///< Faces with the opposite orientation of their neighbours.
    std::vector<InsideOut> inside_out;  ///< Closed bodies that are inside out, by face numbers.
    std::vector<Mark> marks;            ///< Marks of turned faces, inside-out bodies and open edges.
};

/// Analyses which edges the faces share. A face is turned if it traverses shared edges in the same direction as its
/// neighbours, and if at most a third of its connected faces are like it; otherwise it is undecidable which part is
/// wrong. Faces of another object that share less than two thirds of their border edges with those neighbours only
/// touch them, and are not turned. Edges of more than two faces connect nothing. O(n log n) in edges.
Shell inspect_shell(const Scene& scene);

/// Returns the message and hint about an inside-out body; `group` is the group of its first face.
Finding finding_of(const InsideOut& body, const std::string& group, Finding::Kind kind);

/// Returns a warning for every group with turned faces, and for every inside-out body.
std::vector<Finding> findings_of(const Shell& shell, const Scene& scene);

}  // namespace exitance
