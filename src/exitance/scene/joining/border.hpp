#pragma once

#include "exitance/scene/joining/face_mesh.hpp"

namespace exitance {

/// A directed edge of a border, its inside to the left; numbers of points.
struct BorderEdge {
    std::uint32_t from, to;
};

/// The closed loops of a planar border, in the order that JoinedFaces states. Edges that run against each other cancel
/// first. Where several loops meet in a point, each goes on along the side of its own inside. Corners nearer than
/// `tolerance` (metres) to the line through their neighbours are left out.
/// area_vector  what the loops' area vectors must sum to, m^2
/// returns nothing when the edges do not close, or when an edge is there twice: the faces overlap.
std::vector<std::vector<std::uint32_t>> border_loops(std::span<const Point> points, std::vector<BorderEdge> edges,
                                                     const Vec3& area_vector, double tolerance);

/// Turns a loop until it starts at its lexicographically smallest corner.
void start_at_smallest(std::span<const Point> points, std::vector<std::uint32_t>& loop);

/// The loops of one face: one outline, or with holes that bridges connect, an outline and holes.
std::vector<std::vector<std::uint32_t>> lone_face_loops(const FaceMesh& mesh, std::uint32_t face, double tolerance);

}  // namespace exitance
