#pragma once

#include "exitance/basis/nodal_basis.hpp"
#include "exitance/methods/methods.hpp"

namespace exitance {

/// Radiosity over the links of a hierarchy, whatever its basis: what the methods hierarchical and wavelet share.
///
/// Links are refined for an error asked for, with light from a coarser solution (multigridding), the system is solved
/// on them, and again, until the links' own estimate is met. O(k^2 + links) for k pieces. Where the basis holds
/// polynomials, E_ind is delivered as the links give it.
/// Source: [Hanrahan91], [Gortler93].
GlobalLight solve_hierarchy(const MethodInput& input, HierarchyBasis kind);

}  // namespace exitance
