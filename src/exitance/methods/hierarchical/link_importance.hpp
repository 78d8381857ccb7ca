#pragma once

#include "exitance/methods/hierarchical/hierarchy.hpp"

namespace exitance {

/// Returns the weight of squared errors of elements at the points of `--importance`, relative to the mean, per element.
/// By reciprocity the same links transport importance, w = w_0 + F rho w. The system is solved for v = rho w, which
/// satisfies the equation of light: v = rho w_0 + rho F v. Source: [Smits92].
Field<ElementId, double> find_link_importance(Hierarchy& hierarchy);

}  // namespace exitance
