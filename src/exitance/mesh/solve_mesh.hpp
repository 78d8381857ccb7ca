#pragma once

#include <functional>
#include <vector>

#include "exitance/mesh/element_tree.hpp"
#include "exitance/mesh/pieces.hpp"

namespace exitance {

/// Fineness of the initial mesh, before anything is known about the light.
struct MeshSize {
    double edge = 0;  ///< Longest edge of an element, metres.
    /// Elements at a concave edge of a right angle are split parallel to it down to a width of edge / 2^levels. Near
    /// such an edge the solution behaves like a fractional power of the distance, which only strips of decreasing width
    /// can follow [Atkinson00]. At flatter edges the strips are wider (ConcaveBorders), and there are none between the
    /// faces of a smooth body.
    int grading_levels = 0;
    /// Maximum ratio of length to width of strips next to a free end of a concave edge, where the light changes within
    /// the width of a strip; 0: unlimited.
    double longest_end = 0;
};

/// Per border of a piece (border i is from corner i to corner i + 1): how far another surface rises from it in front of
/// the piece's plane. The light that both sides of the fold exchange is proportional to this, 1 - cos(angle between
/// their normals); 1 from a right angle on, 0 if no surface rises. Light exchange is singular at such borders.
using ConcaveBorders = std::vector<double>;

/// Finds the concave borders of each piece, but not those of the small pieces of a crowd (`ErrorShare::is_crowd`, with
/// this `multiplicity`). O(n log n).
std::vector<ConcaveBorders> find_concave_borders(const Scene& scene, const std::vector<Piece>& pieces,
                                                 double multiplicity = 1);

/// Pieces to be meshed, which light reaches, and the factor on the number of elements because they bound many rooms
/// (`LightRooms::multiplicity`).
struct LitSpaces {
    std::vector<Piece> pieces;
    double multiplicity = 1;
};

/// Splits every piece until `size` is met. Strips along concave edges stay long: parallelograms are split across one
/// direction at a time, triangles along lines parallel to the edge, into cells. Triangles without such an edge are
/// split into four. Roots are in the order of the pieces.
/// whole  per region: nonzero if its pieces are not split; may be empty
/// finer  per piece: divisor of the longest edge of its elements; may be empty
ElementTree make_mesh(const std::vector<Piece>& pieces, const std::vector<ConcaveBorders>& concave, MeshSize size,
                      const Field<RegionId, std::uint8_t>& whole = {}, const std::vector<double>& finer = {});

/// Approximate number of elements that make_mesh() would make, without making them.
std::size_t predict_elements(const std::vector<Piece>& pieces, double edge);

/// Edge length (metres) for which predict_elements() is about `count`; large if there are that many pieces already.
double edge_for_elements(const std::vector<Piece>& pieces, std::size_t count);

/// Consecutive numbering of a tree's leaves, for vectors of unknowns.
struct LeafNumbering {
    LeafNumbering() = default;
    explicit LeafNumbering(const ElementTree& tree);

    std::vector<ElementId> leaves;           ///< The leaves, in the order of their ids.
    Field<ElementId, std::uint32_t> number;  ///< Per leaf: its index in `leaves`.
};

/// Area of every leaf, by leaf number, m^2.
std::vector<double> leaf_areas(const ElementTree& tree, const LeafNumbering& numbering);

}  // namespace exitance
