#pragma once

#include <array>
#include <span>

#include "exitance/basis/element_polynomials.hpp"

namespace exitance {

/// Weighted least-squares fit of an element's polynomial to values at points of its domain: linear on triangles and
/// cells, bilinear on parallelograms. Represented by the values at the corners of the element's patch (of a cell, these
/// may lie outside its domain). Exact if the values come from such a polynomial.
class ElementFit {
  public:
    ElementFit(const ElementTree& tree, ElementId e, const std::vector<WeightedPlace>& places,
               std::span<const Spectrum> values);

    Spectrum at(Vec2 uv) const;
    Spectrum corner(int i) const { return at(corner_uv_[static_cast<std::size_t>(i)]); }
    std::size_t freedoms() const { return polynomials_.size(); }

  private:
    ElementPolynomials polynomials_;
    std::array<Vec2, 4> corner_uv_{};
    std::array<Spectrum, 4> coefficient_{};  ///< Coefficient of each polynomial.
};

}  // namespace exitance
