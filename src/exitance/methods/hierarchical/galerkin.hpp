#pragma once

#include "exitance/basis/nodal_basis.hpp"
#include "exitance/methods/methods.hpp"

namespace exitance {

/// Galerkin's method of order 1 to 3 without a hierarchy, with the basis of haar, multiwavelet2 or multiwavelet3. Every
/// leaf of the direct projection is linked to every other one (`leaf_links`). E_ind is delivered or gathered by the
/// rule of `solve_hierarchical`. O(leaves^2). Source: [Zatz93].
GlobalLight solve_galerkin(const MethodInput& input, HierarchyBasis kind);

}  // namespace exitance
