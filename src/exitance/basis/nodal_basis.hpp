#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/base/quadrature.hpp"
#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// The functions that an element of a hierarchy represents.
enum class HierarchyBasis { haar, flatlet2, flatlet3, multiwavelet2, multiwavelet3 };

/// Nodes on a reference shape that represent a function on it, and the transfer of functions between an element and its
/// children.
///
/// An element of order M has M x M coefficients. Multiwavelets (Haar: M = 1): values at the Gauss points of a
/// polynomial of degree M - 1 in each direction (on triangles: of total degree M - 1, at 1, 3 or 6 points; the
/// remaining coefficients have weight 0). Nodal values and coefficients of the orthonormal polynomials are equivalent:
/// the interpolating polynomial is the projection of the function as far as the rule is exact. Flatlets: means over M x
/// M equal boxes (on triangles: equal triangles); a child evaluates them by the polynomial of degree M - 1 with these
/// means.
///
/// Push transfers an element's function to its children without loss. Pull gives an element the best approximation of
/// its children's functions (in the mean square; for flatlets: their means), so that pull after push changes nothing.
/// Source: [Gortler93], [Alpert93]. `two_scale` has the corresponding filters for the halves of an interval.
class NodalBasis {
  public:
    explicit NodalBasis(HierarchyBasis kind);

    HierarchyBasis kind() const { return kind_; }
    int order() const { return order_; }
    bool is_flat() const { return flat_; }                 ///< Flatlets and Haar: constant on each box.
    std::size_t count() const { return order_ * order_; }  ///< Number of coefficients of an element.

    using Shape = Patch::Shape;
    /// The nodes, count() of them; weights sum to 1, and nodes unused on triangles have weight 0.
    std::span<const PlanarNode> nodes(Shape shape) const { return of(shape).nodes; }

    /// Evaluates the element's polynomial at a point: writes the factor of each coefficient, count() entries.
    void interpolate(Shape shape, Vec2 uv, std::span<double> factors) const;

    /// Writes the monomials of the element's polynomials about its centre, monomial_count() entries.
    void monomials(Shape shape, Vec2 uv, std::span<double> out) const;
    std::size_t monomial_count(Shape shape) const;
    /// Converts the values of a linear functional at the monomials to its values at the nodal basis functions (1 at one
    /// node, 0 at the others).
    void from_monomials(Shape shape, std::span<const double> values, std::span<double> out) const;

    /// Matrix from the coefficients of a parent to those of child `child` of a regular split (at the middle): child[k]
    /// = sum_j push[k count() + j] parent[j].
    std::span<const double> push(Shape shape, Cut way, std::size_t child) const;
    /// Matrix from the coefficients of a child to those of the parent: parent[j] = sum over the children and over k of
    /// pull[j count() + k] child[k].
    std::span<const double> pull(Shape shape, Cut way, std::size_t child) const;
    /// Writes the push matrix for a child whose nodes are at these points of the parent.
    void push_to(Shape parent, std::span<const Vec2> places, std::span<double> factors) const;

    /// Flatlets: returns the index of the coefficient (box) that contains the point.
    std::size_t box_at(Shape shape, Vec2 uv) const;

  private:
    struct OfShape {
        std::vector<PlanarNode> nodes;
        std::vector<double> fit;  ///< Matrix from coefficients to monomial coefficients, monomials x count().
        std::vector<double> push[3][4], pull[3][4];
    };
    const OfShape& of(Shape shape) const { return shape == Shape::triangle ? triangle_ : square_; }
    OfShape make(Shape shape) const;
    /// Matrix of the values of each monomial of the shape (columns) for each coefficient (rows) of a piece of it: its
    /// value at the piece's node, or its mean over the piece's box. The piece is a patch in the plane z = 0.
    std::vector<double> functionals(Shape shape, std::span<const PlanarNode> nodes, const Patch& piece) const;
    std::vector<Patch> boxes(const Patch& piece) const;

    HierarchyBasis kind_;
    int order_;
    bool flat_;
    OfShape square_, triangle_;
};

}  // namespace exitance
