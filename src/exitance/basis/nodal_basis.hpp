#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/base/quadrature.hpp"
#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// What the elements of a hierarchy hold.
enum class HierarchyBasis { haar, flatlet2, flatlet3, multiwavelet2, multiwavelet3 };

/// Places of a reference shape that stand for a function on it, and how functions move between an element and its
/// children.
///
/// Of order M an element holds M x M numbers. Multiwavelets (Haar: M = 1): the values at Gauss's points of a
/// polynomial of degree M - 1 in each direction (on triangles: of total degree M - 1, at 1, 3 or 6 points; what is left
/// over has no weight). Numbers at nodes and coefficients of the orthonormal polynomials tell the same: the polynomial
/// through the nodes is the function's projection as far as the rule is exact. Flatlets: the means over M x M equal
/// boxes (on triangles: equal triangles), which a child reads through the polynomial of degree M - 1 with these means.
///
/// Push hands an element's function on to its children and loses nothing; pull gives an element the nearest function
/// (in the mean square; for flatlets: the means) of what its children hold, so that pull after push changes nothing.
/// Source: [Gortler93], [Alpert93]; `two_scale` holds the filters of the halves of an interval, which these agree with.
class NodalBasis {
  public:
    explicit NodalBasis(HierarchyBasis kind);

    HierarchyBasis kind() const { return kind_; }
    int order() const { return order_; }
    bool is_flat() const { return flat_; }                 ///< Flatlets and Haar: constant on every box.
    std::size_t count() const { return order_ * order_; }  ///< Numbers an element holds.

    using Shape = Patch::Shape;
    /// The places, count() of them; weights sum to 1, and those that a triangle does without have weight 0.
    std::span<const PlanarNode> nodes(Shape shape) const { return of(shape).nodes; }

    /// The element's polynomial at a point: the factors of its numbers, count() entries.
    void interpolate(Shape shape, Vec2 uv, std::span<double> factors) const;

    /// Monomials of the element's polynomials about its middle, monomial_count() entries.
    void monomials(Shape shape, Vec2 uv, std::span<double> out) const;
    std::size_t monomial_count(Shape shape) const;
    /// From a functional's values at the monomials: its values at the functions that are 1 at one node.
    void from_monomials(Shape shape, std::span<const double> values, std::span<double> out) const;

    /// Factors by which child `i` of a regular cut (at its middle) takes its numbers from its parent's:
    /// child[k] = sum_j push[k count() + j] parent[j].
    std::span<const double> push(Shape shape, Cut way, std::size_t child) const;
    /// Factors by which an element takes its numbers from those of its children: parent[j] = sum over the children and
    /// over k of pull[j count() + k] child[k].
    std::span<const double> pull(Shape shape, Cut way, std::size_t child) const;
    /// Push factors for a child whose nodes stand at these places of the parent.
    void push_to(Shape parent, std::span<const Vec2> places, std::span<double> factors) const;

    /// A function made of M x M boxes (flatlets), as places to read: which number stands for the point.
    std::size_t box_at(Shape shape, Vec2 uv) const;

  private:
    struct OfShape {
        std::vector<PlanarNode> nodes;
        std::vector<double> fit;  ///< Monomial coefficients from numbers, monomials x count().
        std::vector<double> push[3][4], pull[3][4];
    };
    const OfShape& of(Shape shape) const { return shape == Shape::triangle ? triangle_ : square_; }
    OfShape make(Shape shape) const;
    /// Each monomial of the shape (columns) as each number (rows) of a piece of it sees it: at the piece's node, or in
    /// the mean over its box. The piece is a patch in the plane z = 0.
    std::vector<double> functionals(Shape shape, std::span<const PlanarNode> nodes, const Patch& piece) const;
    std::vector<Patch> boxes(const Patch& piece) const;

    HierarchyBasis kind_;
    int order_;
    bool flat_;
    OfShape square_, triangle_;
};

}  // namespace exitance
