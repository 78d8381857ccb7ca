#pragma once

#include "exitance/mesh/dm_tree/triangulation_scheme.hpp"
#include "exitance/mesh/planar_subdivision.hpp"
#include "exitance/reconstruct/discontinuity/receiver_curves.hpp"

namespace exitance {

struct TriangleOptions {
    TriangulationScheme scheme = TriangulationScheme::delaunay;
    bool grid = false;            ///< Trees begin with a coarse grid,
    bool penumbra_first = false;  ///< and take the curves that bound half-shadows first: kinks and long ones.
    bool refined = false;         ///< Points are added for the triangles' shape.
    double tolerance = 0;         ///< What is nearer is the same for trees, metres.
};

/// The triangles between a receiver's curves, with the memory of the tree that they come from.
struct ReceiverTriangles {
    LabelledTriangles triangles;
    std::size_t tree_bytes = 0;
};

/// By a tree of lines where a scheme of the thesis is asked for and the receiver is convex, else by Delaunay's
/// triangulation; without the curves where they cannot be had.
ReceiverTriangles receiver_triangles(const ReceiverCurves& receiver, const TriangleOptions& options);

}  // namespace exitance
