#include "exitance/methods/hierarchical/hierarchical.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exitance/calibration/numbers.hpp"
#include "exitance/methods/hierarchical/hand_over.hpp"
#include "exitance/methods/hierarchical/link_rounds.hpp"
#include "exitance/methods/hierarchical/linked_by_rays.hpp"
#include "exitance/methods/hierarchical/ray_correction.hpp"
#include "exitance/transport/open_share.hpp"

namespace exitance {
namespace {

/// True if clusters are requested, or by default if there are many pieces. Clusters require links judged by their
/// error.
bool wants_clusters(const MethodInput& input) {
    constexpr std::size_t max_unclustered_pieces = 500;
    const SolveOptions& o = input.options;
    return o.clusters.value_or(input.direct.tree.roots().size() > max_unclustered_pieces &&
                               o.oracle == LinkOracle::transport);
}

/// Clusters read elements before these have links, and light below elements does not follow from the means of flatlets.
LinkSites::Held held_by(const MethodInput& input, HierarchyBasis kind) {
    const bool has_means = kind == HierarchyBasis::flatlet2 || kind == HierarchyBasis::flatlet3;
    return wants_clusters(input) || has_means ? LinkSites::Held::all : LinkSites::Held::roots;
}

/// True if only the links' light is requested, or if polynomials are as exact as required. This depends on the scene,
/// not on the refinement of its links, so that all attempts of one solve agree. False if the plan expects sums over
/// elements (ElementGather) to be cheaper.
bool links_deliver(const Hierarchy& h) {
    const MethodInput& input = h.input;
    if (input.options.smoothing == false) return true;
    if (!h.is_polynomial) return false;
    if (!input.knobs.links_deliver && !input.options.epsilon) return false;
    const LeafNumbering numbering(h.light.tree);
    const ElementLocator locator(h.light.tree, input.stage.scene.regions().size());
    std::vector<Spectrum> light;
    for (ElementId e : numbering.leaves) light.push_back(h.material(e).reflectance * input.direct.fit[e].mean);
    return is_mostly_open(input.stage, {h.light.tree, numbering, locator}, light, input.options.seed);
}

/// Scales the links' light in a closed scene so that no reflected light is lost.
void conserve(Hierarchy& h) {
    const ElementLocator locator(h.light.tree, h.input.stage.scene.regions().size());
    if (!is_closed(h.input.stage, {h.light.tree, h.light.numbering, locator}, h.input.options.seed)) return;
    h.input.progress.phase("solve");
    h.relax(true);
    h.input.progress.note(fmt::format("links lose {:.4f}% of the light", 100 * (mean(h.system.scale()) - 1)));
}

/// Radiosity over the links of a hierarchy with any basis; common to the methods hierarchical and wavelet.
///
/// If light is gathered from the elements afterwards, rays find the links (`solve_linked_by_rays`). Links are judged
/// one by one (`refine_links`) if the basis has polynomials and most light is unoccluded, or if options about links are
/// set. E_ind of polynomials is then delivered as computed by the links; otherwise, and where glass is coloured, rays
/// correct the means. O(rays log rays), or O(k log k + links) for k pieces with clusters, O(k^2 + links) without.
/// Source: [Hanrahan91], [Gortler93], [Smits94].
GlobalLight solve_over_links(const MethodInput& input, HierarchyBasis kind) {
    if (!asks_for_judged_links(input.options)) {
        const bool is_polynomial = kind == HierarchyBasis::multiwavelet2 || kind == HierarchyBasis::multiwavelet3;
        if (std::optional<GlobalLight> light = solve_linked_by_rays(input, is_polynomial)) return std::move(*light);
    }
    Hierarchy h(input, kind, held_by(input, kind));
    if (wants_clusters(input)) h.make_clusters();
    // Links have no colours: where glass is coloured, rays correct their light.
    if (links_deliver(h) && input.stage.glass.empty()) h.light.delivery = MethodDelivery::polynomials;
    h.project_direct();
    if (!refine_links(h)) return std::move(h.light);
    if (h.light.delivers())
        conserve(h);
    else if (!input.stop.requested())
        correct_by_rays(h);
    hand_over(h);
    return std::move(h.light);
}

}  // namespace

bool asks_for_judged_links(const SolveOptions& o) {
    return o.basis || o.epsilon || o.oracle != LinkOracle::transport || !o.importance.empty() || o.smoothing ||
           !o.triage || o.visibility != VisibilityKind::automatic || o.clusters || o.min_area;
}

bool links_outgrow_memory(std::size_t pieces, const SolveOptions& options) {
    constexpr double visible_share = 0.5;
    const double pairs = visible_share * std::pow(static_cast<double>(pieces), 2);
    return options.memory_limit_bytes &&
           pairs * LinkRefiner::bytes_a_link > static_cast<double>(*options.memory_limit_bytes);
}

/// Hierarchical radiosity [Hanrahan91]: constant elements, links between levels.
GlobalLight solve_hierarchical(const MethodInput& input) {
    return solve_over_links(input, HierarchyBasis::haar);
}

/// Wavelet radiosity [Gortler93]: hierarchical radiosity with the requested basis, by default multiwavelets of order 2.
GlobalLight solve_wavelet(const MethodInput& input) {
    switch (input.options.basis.value_or(BasisKind::multiwavelet2)) {
        case BasisKind::haar:
            return solve_over_links(input, HierarchyBasis::haar);
        case BasisKind::flatlet2:
            return solve_over_links(input, HierarchyBasis::flatlet2);
        case BasisKind::flatlet3:
            return solve_over_links(input, HierarchyBasis::flatlet3);
        case BasisKind::multiwavelet3:
            return solve_over_links(input, HierarchyBasis::multiwavelet3);
        default:
            return solve_over_links(input, HierarchyBasis::multiwavelet2);
    }
}

}  // namespace exitance
