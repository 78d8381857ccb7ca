#include "exitance/methods/hierarchical/linked_by_rays.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exitance/calibration/error_budget.hpp"
#include "exitance/links/ray_links.hpp"
#include "exitance/methods/constant_elements.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/transport/open_share.hpp"

namespace exitance {
namespace {

/// Distributed over the hierarchy, half of the rays of independent rows suffice.
RayBudget dealt_out(RayBudget rays) {
    constexpr double share = 0.5;
    constexpr unsigned min_rays = 8;
    rays.average *= share;
    rays.min = std::min(rays.min, min_rays);
    return rays;
}

/// Reflected direct light of leaves, W/m^2.
std::vector<Spectrum> reflect_once(const Scene& scene, const GlobalLight& light) {
    std::vector<Spectrum> b = leaf_reflectances(scene, light.tree, light.numbering);
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = b[i] * light.direct[i];
    return b;
}

/// Adds the light of a second reflection, enough to find where light is uniform.
void reflect_again(const RayRows& rows, const Scene& scene, GlobalLight& light) {
    const std::vector<Spectrum> rho = leaf_reflectances(scene, light.tree, light.numbering);
    std::vector<Spectrum> E(rho.size());
    rows.gather(light.reflected, E);
    for (std::size_t i = 0; i < rho.size(); ++i) light.reflected[i] += rho[i] * E[i];
}

/// Permitted error of one of `count` links, W/m^2 m. Errors from evaluating a whole element are equal for neighbours,
/// and every reflection multiplies them.
double allowed_error(const MethodInput& input, const GlobalLight& light, std::size_t count) {
    return ErrorBudget::share_of_links_by_rays * input.knobs.link_error * light.mean_reflected(input.stage.area) /
           input.stage.expected_reflections() * std::sqrt(input.stage.area / static_cast<double>(count));
}

}  // namespace

std::optional<GlobalLight> solve_linked_by_rays(const MethodInput& input, bool unless_open) {
    const Stage& stage = input.stage;
    input.progress.phase("link");
    GlobalLight light{.tree = input.direct.tree, .numbering = LeafNumbering(input.direct.tree)};
    const std::vector<ElementId>& leaves = light.numbering.leaves;
    light.direct = leaf_means(input.direct, light.numbering);
    light.on_projection = true;
    const ElementLocator locator(light.tree, stage.scene.regions().size());
    light.reflected = reflect_once(stage.scene, light);
    const NumberedLeaves numbered{light.tree, light.numbering, locator};
    if (unless_open && is_mostly_open(stage, numbered, light.reflected, input.options.seed)) return std::nullopt;
    const RayRows rows(stage, numbered,
                       {dealt_out(input.knobs.solve_rays), input.options.seed, Dealing::by_piece, RowsHeld::by_owner});
    light.work.rays = rows.rays();
    light.kept = kept_light(rows, stage);
    reflect_again(rows, stage.scene, light);

    if (!stage.glass.empty()) {  // links have no colours
        relax_constant_elements(input, rows, light);
        light.work.element_memory_bytes = light.tree.memory_bytes();
        return light;
    }
    const NodalBasis constants(HierarchyBasis::haar);
    const LinkSites sites(stage, light.tree, constants);
    NodalField b(sites);
    for (std::size_t i = 0; i < leaves.size(); ++i) b.set_node(leaves[i], 0, light.reflected[i]);
    b.pull();
    const Links links = link_by_rays(sites, light.numbering, rows, b, allowed_error(input, light, rows.rays()));
    light.work.links = static_cast<std::size_t>(sum_of_all(static_cast<double>(links.size())));
    input.progress.note(
        fmt::format("{} links found by {} rays of {} leaves", light.work.links, rows.rays(), leaves.size()));

    // Every leaf has links of its own: the part is the whole hierarchy.
    const ElementPart part{sites.inner(), leaves};
    relax_constant_elements(input, LinkOperator(sites, links, nullptr, part, rows.dealt().block()), light);
    light.work.element_memory_bytes = light.tree.memory_bytes() + sites.memory_bytes() + b.memory_bytes();
    light.work.elements_by_level = sites.count_by_level();
    if (input.options.keep_links) light.kept_links = list_of_all(links, light.numbering);
    return light;
}

}  // namespace exitance
