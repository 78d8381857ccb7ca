#pragma once

#include "exitance/solution/solution.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

/// Light to be gathered once more where it is summed over elements, one step of iterative refinement on from what was
/// gathered: functions that add up to
///
///     b1 + (I - rho F)^-1 (rho (E_dir + H b1) - b1),    b1 = rho (E_dir + E_ind)
///
/// (with the share c of `find_direct_share`, see DeliveredLight). The residual is summed at the middle of every leaf
/// that the method solved on, and F are rays between those: what is left of the error of E_ind is a product of two
/// small numbers. A method's elements deal light out evenly over each of them, and so carry it further down a tube than
/// it goes; that comes back from every reflection, and no gather mends it. `share`: what one element may miss of a sum.
/// Source: [Atkinson97], part "two-grid iteration". O(leaves x elements of a sum).
std::vector<ElementFunction> refined_light(const Stage& stage, const GlobalLight& light,
                                           const ElementFunction& indirect, const DirectProjection& direct,
                                           const Spectrum& c, RayBudget rays, double share, std::uint64_t seed);

}  // namespace exitance
