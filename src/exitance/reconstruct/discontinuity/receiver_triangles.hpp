#pragma once

#include "exitance/mesh/dm_tree/triangulation_scheme.hpp"
#include "exitance/mesh/planar_subdivision.hpp"
#include "exitance/reconstruct/discontinuity/receiver_curves.hpp"

namespace exitance {

struct TriangleOptions {
    TriangulationScheme scheme = TriangulationScheme::delaunay;
    bool grid = false;  ///< Insert a coarse grid into the line tree first.
    /// Insert curves in the order D0, D1, D2, long ones first: the edges of penumbras before the rest.
    bool penumbra_first = false;
    bool refined = false;  ///< Add points for better triangle shapes.
    double tolerance = 0;  ///< Line trees merge points closer than this, metres.
};

/// The triangles between a receiver's curves, and the memory of the line tree that they were made from.
struct ReceiverTriangles {
    LabelledTriangles triangles;
    std::size_t tree_bytes = 0;
};

/// Triangulates a receiver along its curves. It uses a line tree if the thesis's scheme is requested and the receiver
/// is convex, otherwise a Delaunay triangulation. Omits the curves if they cannot be triangulated.
ReceiverTriangles receiver_triangles(const ReceiverCurves& receiver, const TriangleOptions& options);

}  // namespace exitance
