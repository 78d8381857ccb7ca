#pragma once

#include <array>
#include <vector>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// A place of an element and its share in a mean over the element; the shares of a rule sum to 1.
struct WeightedPlace {
    Vec2 uv;
    double weight;
};

/// How many places a rule takes.
enum class RuleOrder {
    nodes,  ///< As many as the polynomial has freedoms: 2 x 2 Gauss, 3 on triangles, one a corner on cells.
    fine,   ///< Enough to judge the polynomial by: 3 x 3 Gauss, 7 on triangles [Radon48], 3 a corner on cells.
};

/// A quadrature rule over the domain of an element, in the element's own coordinates. On parallelograms and
/// triangles `nodes` is exact for polynomials of degree 2 or more and `fine` of degree 5; on cells of degree 0 and 2.
std::vector<WeightedPlace> element_rule(const ElementTree& tree, ElementId e, RuleOrder order);

/// The polynomial of an element that is nearest, in the weighted mean square, to values at places of its domain: linear
/// on triangles and cells, bilinear on parallelograms. Given by its values at the corners of the element's patch (for
/// a cell these may lie outside its domain). Exact where the values come from such a polynomial.
class ElementFit {
  public:
    ElementFit(const ElementTree& tree, ElementId e, const std::vector<WeightedPlace>& places,
               std::span<const Spectrum> values);

    Spectrum at(Vec2 uv) const;
    Spectrum corner(int i) const { return at(corner_uv_[static_cast<std::size_t>(i)]); }
    std::size_t freedoms() const { return freedoms_; }

  private:
    std::array<double, 4> basis_at(Vec2 uv) const;

    std::size_t freedoms_;
    Vec2 middle_;
    std::array<Vec2, 4> corner_uv_{};
    std::array<Spectrum, 4> coefficient_{};  ///< Of 1, s, t, st with (s, t) = (u, v) - middle.
};

}  // namespace exitance
