#pragma once

#include "exitance/scene/joining/face_mesh.hpp"

namespace exitance {

/// A directed edge of a border between two points, given by number. The inside of the border is to its left.
struct BorderEdge {
    std::uint32_t from, to;
};

/// Closed loops of a planar border, in the order described in JoinedFaces. Edges in opposite directions between the
/// same points cancel first. If several loops meet at a point, each continues along its own inside. Corners nearer than
/// `tolerance` (metres) to the line through their neighbours are omitted.
/// area_vector  required sum of the loops' area vectors, m^2
/// Returns no loops if the edges do not close, or if an edge occurs twice (the faces overlap).
std::vector<std::vector<std::uint32_t>> border_loops(std::span<const Point> points, std::vector<BorderEdge> edges,
                                                     const Vec3& area_vector, double tolerance);

/// Rotates a loop so that it starts at its lexicographically smallest corner.
void start_at_smallest(std::span<const Point> points, std::vector<std::uint32_t>& loop);

/// The loops of one face: its outline, or an outline and holes if the face has holes connected by bridges.
std::vector<std::vector<std::uint32_t>> lone_face_loops(const FaceMesh& mesh, std::uint32_t face, double tolerance);

}  // namespace exitance
