#pragma once

#include <functional>
#include <vector>

#include "exitance/mesh/element_tree.hpp"
#include "exitance/mesh/pieces.hpp"

namespace exitance {

/// How fine a mesh is to be, before anything is known of the light.
struct MeshSize {
    double edge = 0;  ///< Longest edge of an element, metres.
    /// Elements that touch a concave edge are cut, across the edge, down to edge / 2^levels: near such an edge the
    /// solution rises like a broken power of the distance, and only strips that shrink with it follow [Atkinson00].
    int grading_levels = 0;
    /// Where a concave edge ends in the open, light turns within the width of a strip: there strips are cut, too, until
    /// they are no longer than this many times their width; 0: not.
    double longest_end = 0;
};

/// Which borders of a piece, in the order of its corners (border i leads from corner i to corner i + 1), meet another
/// surface in front of the piece's plane at an angle below 180 degrees: there light between the two is singular.
using ConcaveBorders = std::vector<bool>;

/// The concave borders of each piece. O(n log n).
std::vector<ConcaveBorders> find_concave_borders(const Scene& scene, const std::vector<Piece>& pieces);

/// Cuts every piece until `size` is met. Strips along concave edges stay long: parallelograms are cut across one
/// direction at a time, triangles along lines parallel to the edge, into cells; triangles without such an edge are cut
/// into four. Roots stand in the order of the pieces. Pieces of the regions marked in `whole`, if any, are not cut;
/// `finer`, if any, divides the longest edge of each piece's elements.
ElementTree make_mesh(const std::vector<Piece>& pieces, const std::vector<ConcaveBorders>& concave, MeshSize size,
                      const Field<RegionId, std::uint8_t>& whole = {}, const std::vector<double>& finer = {});

/// About how many elements make_mesh would make, without making them.
std::size_t predict_elements(const std::vector<Piece>& pieces, double edge);

/// The edge for which predict_elements is about `count`, metres; large when the pieces alone are as many.
double edge_for_elements(const std::vector<Piece>& pieces, std::size_t count);

/// The leaves of a tree as a flat numbering, for vectors of unknowns.
struct LeafNumbering {
    LeafNumbering() = default;
    explicit LeafNumbering(const ElementTree& tree);

    std::vector<ElementId> leaves;           ///< In order of their ids.
    Field<ElementId, std::uint32_t> number;  ///< Of a leaf: its place in `leaves`.
};

/// Area of every leaf, by leaf number, m^2.
std::vector<double> leaf_areas(const ElementTree& tree, const LeafNumbering& numbering);

}  // namespace exitance
