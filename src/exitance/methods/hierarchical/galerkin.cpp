#include "exitance/methods/hierarchical/galerkin.hpp"

#include <fmt/format.h>

#include "exitance/links/leaf_links.hpp"
#include "exitance/methods/hierarchical/hand_over.hpp"
#include "exitance/methods/hierarchical/link_rounds.hpp"
#include "exitance/transport/open_share.hpp"

namespace exitance {

GlobalLight solve_galerkin(const MethodInput& input, HierarchyBasis kind) {
    Hierarchy h(input, kind, LinkSites::Held::all);
    h.project_direct();
    input.progress.phase("link");
    h.light.numbering = LeafNumbering(h.light.tree);
    const std::size_t leaves = h.light.numbering.leaves.size();
    // Even if all links have the same error, their sum is within the requested one.
    const double demand = input.knobs.link_error * h.light_norm();
    LeafLinks found =
        link_leaves(h.sites, h.radiosity, link_tolerance(h, demand / static_cast<double>(leaves)), input.stop);
    h.system.set_links(std::move(found.links));
    input.progress.note(
        fmt::format("{} links between {} leaves ({:.0f}% of their light in the open), {} rays; error of rules and "
                    "visibility {:.3f}%",
                    h.system.size(), leaves, 100 * found.open_share, found.rays, 100 * found.error / h.light_norm()));
    h.light.work.rays += found.rays;
    h.light.work.form_factors += found.form_factors;
    if (h.is_polynomial && found.open_share > mostly_open) h.light.delivery = MethodDelivery::polynomials;
    input.progress.phase("solve");
    h.relax();
    hand_over(h);
    return std::move(h.light);
}

}  // namespace exitance
