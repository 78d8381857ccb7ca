#pragma once

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
    finer,  ///< Enough to judge one of second degree by: 16, `scattered_square_rule`, [Dunavant85], or those on cells
            ///< of 3 or 4 corners.
};

/// A quadrature rule over the domain of an element, in the element's own coordinates. On parallelograms and
/// triangles `nodes` is exact for polynomials of degree 2 or more, `fine` of degree 5 and `finer` of 8; on
/// cells of degree 0, 2 and, with 3, 4 or more corners, 8, 3 and 2.
std::vector<WeightedPlace> element_rule(const ElementTree& tree, ElementId e, RuleOrder order);

}  // namespace exitance
