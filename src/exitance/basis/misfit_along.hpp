#pragma once

#include <array>
#include <span>

#include "exitance/base/spectrum.hpp"
#include "exitance/basis/element_rule.hpp"

namespace exitance {

/// Degree of an element's polynomial in each coordinate: 1 or 2.
enum class Degree : std::uint8_t { straight, curved };

/// Estimates how much of the misfit of a parallelogram's polynomial one split across u, or one across v, would mostly
/// remove. `rest` is the misfit at the points of a rule. With s and t from -1 to 1, and P the Legendre polynomial of
/// the first degree that the element does not represent, returns the mean squares (over points and bands) of two
/// components of the misfit: P(s) (c + d t) and P(t) (c + d s).
/// Rules: `fine` for straight elements, `finer` for curved ones. They are exact for products of these components with
/// the element's own polynomials, which therefore contribute nothing. Returns 0 on triangles and cells.
std::array<double, 2> misfit_along(const ElementTree& tree, ElementId e, const std::vector<WeightedPlace>& places,
                                   std::span<const Spectrum> rest, Degree degree);

}  // namespace exitance
