#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/links/error/link_judge.hpp"

namespace exitance {

/// Links between leaves alone, and their error.
struct LeafLinks {
    Links links;
    double error = 0;       ///< Root of areas times squared errors, of rules and visibility, W/m^2 m.
    double open_share = 1;  ///< Share of their light that certainly meets nothing on its way.
    std::size_t rays = 0, form_factors = 0;
};

/// Every leaf gathers from every leaf that it may see, whatever it brings: the blocks of Galerkin's matrix, without a
/// hierarchy,
///
///     K_ij,kl = int over p_i and p_j of  N_k G V N_l  / int N_k^2,    i, j: leaves, k, l: their functions
///
/// by Gauss's rule on the receiver, and on the source by Gauss's rule or, where it is near, by cuts (NearRow). A block
/// is kept as a link is (Links): what may be made anew is. `b`: reflected light, W/m^2, by whose amount `tolerance`
/// decides which blocks take the dearer rule and more rays. What stands between two pieces is classified once for all
/// pairs of their leaves. Once a stop is asked for, what is left stays without links. O(leaves^2)
/// time and links; the same on any number of threads. Source: [Zatz93].
LeafLinks link_leaves(const LinkSites& sites, const NodalField& b, const LinkTolerance& tolerance,
                      const StopRequest& stop);

}  // namespace exitance
