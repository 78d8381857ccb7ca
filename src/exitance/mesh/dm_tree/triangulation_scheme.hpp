#pragma once

namespace exitance {

/// Triangulation of faces. Source: [Gatenby95], except for the last scheme, which needs no construction edges.
enum class TriangulationScheme {
    longest,    ///< Joins the middle of the longest diagonal to all corners.
    shortest,   ///< Repeatedly cuts along the shortest diagonal.
    heuristic,  ///< Cuts along the diagonal that divides the angles at its ends best.
    delaunay,   ///< Constrained Delaunay triangulation of the curves: maximizes the smallest angle.
};

}  // namespace exitance
