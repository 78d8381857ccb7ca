#pragma once

#include "exitance/methods/hierarchical/hierarchy.hpp"

namespace exitance {

/// Weight of squared errors of elements at the points of `--importance`, relative to the mean, by element: by
/// reciprocity the same links bear it, w = w_0 + F rho w. Solved for rho w, which obeys the equation of light:
/// v = rho w_0 + rho F v. Source: [Smits92].
Field<ElementId, double> find_link_importance(Hierarchy& hierarchy);

}  // namespace exitance
