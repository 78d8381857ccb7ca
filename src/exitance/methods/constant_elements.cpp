#include "exitance/methods/constant_elements.hpp"

#include <algorithm>

#include "exitance/solve/conserving_transport.hpp"
#include "exitance/solve/direct_share.hpp"

namespace exitance {
namespace {

/// Solves b = first + rho F b iteratively, starting from `light.reflected`.
void solve(const MethodInput& input, ConservingTransport& F, std::span<const Spectrum> rho,
           std::span<const Spectrum> first, std::span<const double> area, GlobalLight& light) {
    light.report = solve_conserving(
        {F, rho, first, area}, F, !light.kept.empty(), input.options.relaxation.value_or(Relaxation::gmres),
        light.reflected,
        {.residual = input.knobs.residual, .max_iterations = input.knobs.max_iterations, .request = &input.stop});
}

/// If surfaces emit all over the scene, direct light found by the rays of F, F M, replaces the share c of the exact
/// direct light: E_ind = F (b + c M) - c E_dir. The noise of F then affects only the variation of b + c M.
void agree_with_direct_share(const MethodInput& input, ConservingTransport& F, std::span<const Spectrum> rho,
                             std::span<const double> area, GlobalLight& light) {
    const ElementLocator locator(light.tree, input.stage.scene.regions().size());
    const Spectrum c = find_direct_share(input.stage, light, locator, input.options.seed);
    if (squared(c) == 0 || input.stop.requested()) return;
    const std::size_t n = rho.size();
    std::vector<Spectrum> M(n), correction(n), first(n);
    for (std::size_t i = 0; i < n; ++i)
        M[i] = input.stage.scene.material(light.tree.region(light.numbering.leaves[i])).exitance;
    ConservingTransport of_emitted = F;  // the emitted light is scaled separately to conserve its flux
    if (!light.kept.empty()) of_emitted.conserve(M);
    of_emitted.gather(M, correction);
    for (std::size_t i = 0; i < n; ++i) {
        correction[i] = c * (correction[i] - light.direct[i]);
        first[i] = rho[i] * (light.direct[i] + correction[i]);
    }
    const SolveReport before = light.report;
    solve(input, F, rho, first, area, light);
    light.report.iterations += before.iterations;
    light.report.unscaled = before.unscaled;  // F has been scaled in the first solve
    F.gather(light.reflected, light.indirect);
    for (std::size_t i = 0; i < n; ++i) light.indirect[i] += correction[i];
    light.direct_share = c;
}

}  // namespace

std::vector<double> kept_light(const RayRows& rows, const Stage& stage) {
    std::vector<double> kept = rows.kept();
    const auto is_open = [](double share) { return share < 1; };
    // Through coloured glass each band loses a different share: one number per row is not enough.
    const bool differs = stage.scene.has_diffusing_panes() || !stage.glass.empty();
    if (differs && std::any_of(kept.begin(), kept.end(), is_open)) kept.clear();
    return kept;
}

void relax_constant_elements(const MethodInput& input, const TransportOperator& rows, GlobalLight& light) {
    input.progress.phase("solve");
    const std::vector<double> area = leaf_areas(light.tree, light.numbering);
    ConservingTransport F(rows, area, light.kept);
    const std::vector<Spectrum> rho = leaf_reflectances(input.stage.scene, light.tree, light.numbering);
    std::vector<Spectrum> first(rho.size());
    for (std::size_t i = 0; i < rho.size(); ++i) first[i] = rho[i] * light.direct[i];
    light.indirect.resize(rho.size());
    if (light.reflected.empty() || input.options.bounces > 0) light.reflected = first;
    if (input.options.bounces > 0) {
        // Terms of the series first + rho F first + ..., one per bounce.
        for (int bounce = 1; bounce < input.options.bounces; ++bounce) {
            F.gather(light.reflected, light.indirect);
            for (std::size_t i = 0; i < rho.size(); ++i) light.reflected[i] = first[i] + rho[i] * light.indirect[i];
        }
        light.report = {.iterations = static_cast<std::size_t>(input.options.bounces), .converged = true};
    } else {
        solve(input, F, rho, first, area, light);
        F.gather(light.reflected, light.indirect);
        agree_with_direct_share(input, F, rho, area, light);
    }
    light.work.link_memory_bytes = F.memory_bytes();
}

}  // namespace exitance
