#pragma once

#include <vector>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// A point of an element and its quadrature weight; the weights of a rule sum to 1.
struct WeightedPlace {
    Vec2 uv;
    double weight;
};

/// Number of points of a rule.
enum class RuleOrder {
    nodes,  ///< One point per coefficient of the polynomial: 2 x 2 Gauss, 3 on triangles, one per corner on cells.
    fine,   ///< Enough to measure the error of a linear fit: 3 x 3 Gauss points, 7 on triangles [Radon48].
            ///< Cells have 3 points per corner.
    finer,  ///< Enough for a fit of second degree: the 16 points of `scattered_square_rule` or of [Dunavant85].
            ///< Cells of 3 or 4 corners have these points, mapped to the cell.
};

/// Returns a quadrature rule over the domain of an element, in the element's own coordinates. On parallelograms and
/// triangles `nodes` is exact for polynomials of degree 2 or more, `fine` of degree 5 and `finer` of 8. On cells,
/// `nodes` is exact to degree 0, `fine` to 2, and `finer` to degree 8, 3 and 2 for 3, 4 or more corners.
std::vector<WeightedPlace> element_rule(const ElementTree& tree, ElementId e, RuleOrder order);

}  // namespace exitance
