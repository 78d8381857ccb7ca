#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/links/error/link_judge.hpp"

namespace exitance {

/// Links between leaves only, and their error.
struct LeafLinks {
    Links links;
    double error = 0;       ///< Root of the sum of areas times squared errors of rules and visibility, W/m^2 m.
    double open_share = 1;  ///< Share of the links' light that is certainly unoccluded.
    std::size_t rays = 0, form_factors = 0;
};

/// Links every leaf to every leaf that it may see, however small the contribution. The links are the blocks of the
/// Galerkin matrix, without a hierarchy,
///
///     K_ij,kl = int over p_i and p_j of  N_k G V N_l  / int N_k^2,    i, j: leaves, k, l: their functions
///
/// computed by Gauss quadrature on the receiver and on the source, or by subdivision of the source if it is near
/// (NearRow). A block is stored like a link (Links): it is recomputed unless that is too inaccurate. Occluders between
/// two pieces are classified once for all pairs of their leaves.
/// b  reflected light, W/m^2; with `tolerance` it decides which blocks use the more expensive rule and more rays
/// stop  leaves that are not processed when it is requested have no links
/// O(leaves^2) time and links. Independent of the number of threads. Source: [Zatz93].
LeafLinks link_leaves(const LinkSites& sites, const NodalField& b, const LinkTolerance& tolerance,
                      const StopRequest& stop);

}  // namespace exitance
