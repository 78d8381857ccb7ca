#pragma once

#include "exitance/methods/light/refinement_input.hpp"

namespace exitance {

/// Light for another gather by sums over elements: one step of iterative refinement. Returns functions whose sum is
///
///     b1 + (I - rho F)^-1 (rho (E_dir + H b1) - b1),    b1 = rho (E_dir + E_ind)
///
/// (with the share c of `find_direct_share`, see DeliveredLight). The residual is summed at the nodes of every leaf of
/// the method, and F are rays between leaves. The remaining error of E_ind is a product of two small numbers. Without
/// this step, constant elements spread light evenly and thus transport it too far along a tube. Every reflection
/// multiplies that error, and no gather corrects it. `share`: permitted error of one element in a sum. Source:
/// [Atkinson97], part "two-grid iteration". O(leaves x elements of a sum).
std::vector<ElementFunction> corrected_sums(const RefinementInput& in, double share);

}  // namespace exitance
