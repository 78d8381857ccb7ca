#pragma once

#include "exitance/basis/element_rule.hpp"

namespace exitance {

/// Polynomials on the domain of an element that are orthonormal in the weighted mean over the points of a rule. The
/// projection of f has coefficients c_k = sum_i w_i f(x_i) phi_k(x_i), and sum_k c_k^2 is its mean square. First the
/// linear ones of `ElementFit` (1, s, t, and s t on parallelograms), then those of second degree: s^2, s t, t^2 on
/// triangles and cells, and s^2, t^2, s^2 t, s t^2, s^2 t^2 on parallelograms. Computed by Gram-Schmidt on monomials
/// about the centre.
class ElementPolynomials {
  public:
    static constexpr std::size_t max_count = 9;
    using Values = std::array<double, max_count>;

    /// Makes the polynomials of an element. If `curved`, includes second degree.
    ElementPolynomials(const ElementTree& tree, ElementId e, const std::vector<WeightedPlace>& places, bool curved);

    std::size_t size() const { return size_; }
    std::size_t straight() const { return straight_; }  ///< Number of linear (bilinear) polynomials.
    /// Returns phi_k at (u, v) of the element; 0 for k >= size().
    Values at(Vec2 uv) const;

  private:
    Values monomials(Vec2 uv) const;

    bool square_;
    std::size_t straight_, size_;
    Vec2 middle_, scale_;
    std::array<Values, max_count> row_{};  ///< phi_k = sum_j row_[k][j] x monomial j, j <= k.
};

}  // namespace exitance
