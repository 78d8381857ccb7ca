#pragma once

namespace exitance {

/// How faces become triangles. Source: [Gatenby95]; the last one is ours, without construction edges.
enum class TriangulationScheme {
    longest,    ///< The middle of the longest diagonal is joined to all corners.
    shortest,   ///< The shortest diagonal cuts, again and again.
    heuristic,  ///< The diagonal cuts that splits the angles at its ends best.
    delaunay,   ///< Of the curves alone, with the largest smallest angle.
};

}  // namespace exitance
