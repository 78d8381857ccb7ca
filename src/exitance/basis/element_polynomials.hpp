#pragma once

#include "exitance/basis/element_rule.hpp"

namespace exitance {

/// Polynomials on the domain of an element, orthonormal in the weighted mean over the places of a rule: the projection
/// of f has the coefficients c_k = sum_i w_i f(x_i) phi_k(x_i), and sum_k c_k^2 is its mean square. First the straight
/// ones, which `ElementFit` has, too (1, s, t, and s t on parallelograms), then those of second degree: s^2, t^2, and
/// s^2 t, s t^2, s^2 t^2 on parallelograms. Gram and Schmidt's process on monomials around the middle.
class ElementPolynomials {
  public:
    static constexpr std::size_t most = 9;
    using Values = std::array<double, most>;

    /// With those of second degree, or without.
    ElementPolynomials(const ElementTree& tree, ElementId e, const std::vector<WeightedPlace>& places, bool curved);

    std::size_t size() const { return size_; }
    std::size_t straight() const { return straight_; }  ///< How many of them are.
    /// phi_k at (u, v) of the element; 0 beyond size().
    Values at(Vec2 uv) const;

  private:
    Values monomials(Vec2 uv) const;

    bool square_;
    std::size_t straight_, size_;
    Vec2 middle_, scale_;
    std::array<Values, most> row_{};  ///< phi_k = sum_j row_[k][j] x monomial j, j <= k.
};

}  // namespace exitance
