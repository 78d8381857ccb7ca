#pragma once

#include "exitance/basis/nodal_basis.hpp"
#include "exitance/methods/methods.hpp"

namespace exitance {

/// Radiosity over the links of a hierarchy, whatever its basis: what the methods hierarchical and wavelet share.
///
/// Where light is gathered from the elements afterwards, rays find the links (`solve_linked_by_rays`). Where the basis
/// holds polynomials and most light passes in the open, or where something about links is asked for, they are judged
/// one by one: refined for an error asked for, with light from a coarser solution (multigridding), the system is solved
/// on them, and again, until the links' own estimate is met; E_ind of polynomials is then delivered as the links give
/// it. O(rays log rays); or O(k log k + links) for k pieces under clusters, O(k^2 + links) without. Source:
/// [Hanrahan91], [Gortler93], [Smits94].
GlobalLight solve_hierarchy(const MethodInput& input, HierarchyBasis kind);

/// The same without a hierarchy: Galerkin's method of order 1 to 3, whose basis is that of haar, multiwavelet2 or
/// multiwavelet3. Every leaf of the direct projection is linked to every leaf, once (`leaf_links`); E_ind is delivered,
/// or gathered, by the same rule. O(leaves^2). Source: [Zatz93].
GlobalLight solve_galerkin(const MethodInput& input, HierarchyBasis kind);

/// Would links between all pieces that see each other, about half of the pairs, take more than `--memory-limit`?
bool links_outgrow_memory(std::size_t pieces, const SolveOptions& options);

}  // namespace exitance
