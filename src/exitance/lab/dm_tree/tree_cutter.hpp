#pragma once

#include "exitance/discontinuity/receiver_triangles.hpp"
#include "exitance/solve/discontinuity_choice.hpp"

namespace exitance {

/// A scheme of the thesis, and the order in which its tree takes the curves.
struct TreeCut {
    TriangulationScheme scheme = TriangulationScheme::heuristic;
    bool grid = false;  ///< Insert a coarse grid into the line tree first.
    /// Insert curves in the order D0, D1, D2, long ones first: the edges of penumbras before the rest.
    bool penumbra_first = false;
};

/// Cuts convex receivers by a tree of lines (`DmTree`); returns nothing for others, and where the tree, which merges
/// points that are near, would lose area. Source: [Gatenby95].
std::optional<ReceiverTriangles> cut_by_tree(const ReceiverCurves& receiver, const TreeCut& cut, double tolerance);

}  // namespace exitance
