#pragma once

#include <array>
#include <span>

#include "exitance/base/spectrum.hpp"
#include "exitance/basis/element_rule.hpp"

namespace exitance {

/// The degree of the polynomials that an element holds in each coordinate.
enum class Degree : std::uint8_t { straight, curved };

/// How much of what a parallelogram's polynomial leaves over (`rest`, at the places of a rule) one cut across u, or one
/// across v, would mostly be rid of: the mean squares over places and bands of its parts P(s) (c + d t) and
/// P(t) (c + d s), s and t from -1 to 1, where P is Legendre's polynomial of the first degree that the element has not.
/// The rule, the fine one of straight elements and the finer one of curved ones, is exact for products of these with
/// the element's own polynomials, which therefore add nothing. 0 on triangles and cells.
std::array<double, 2> misfit_along(const ElementTree& tree, ElementId e, const std::vector<WeightedPlace>& places,
                                   std::span<const Spectrum> rest, Degree degree);

}  // namespace exitance
