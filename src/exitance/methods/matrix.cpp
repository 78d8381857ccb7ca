#include <algorithm>
#include <cmath>

#include "exitance/methods/constant_elements.hpp"
#include "exitance/methods/hierarchical/galerkin.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/transport/crowd_rays.hpp"
#include "exitance/transport/hemicube_rows.hpp"
#include "exitance/transport/linear_rows.hpp"
#include "exitance/transport/passed_light.hpp"
#include "exitance/transport/patch_transfer.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {
namespace {

/// Solves on linear elements: collocation at the nodes of every leaf, E = first + H rho E, for the indirect irradiance
/// E.
void solve_linear(const MethodInput& input, GlobalLight& light) {
    const ElementLocator locator(light.tree, input.stage.scene.regions().size());
    const LinearRows H(input.stage, input.direct, light.numbering, locator, input.knobs.solve_rays, input.options.seed);
    input.progress.phase("solve");
    const std::vector<Spectrum> first = H.first_reflection(input.direct), ones(H.size(), Spectrum(1.0));
    const std::vector<double> area = H.node_areas();
    std::vector<Spectrum> E = first;
    const Relaxation asked = input.options.relaxation.value_or(Relaxation::gmres);
    // The collocation matrix is not symmetric, so conjugate gradients do not apply.
    const Relaxation method = asked == Relaxation::cg ? Relaxation::gmres : asked;
    light.report = solve_radiosity(
        {H, ones, first, area}, method, E,
        {.residual = input.knobs.residual, .max_iterations = input.knobs.max_iterations, .request = &input.stop});
    const std::vector<Spectrum> rho = leaf_reflectances(input.stage.scene, light.tree, light.numbering);
    for (std::size_t i = 0; i < rho.size(); ++i) {
        light.indirect_corners.push_back(H.corners(i, E));
        light.indirect.push_back(H.mean(i, E));
        light.reflected.push_back(rho[i] * (light.direct[i] + light.indirect[i]));
    }
    light.work.rays = light.work.links = H.rays();
    light.work.link_memory_bytes = H.memory_bytes();
}

/// Rays of the rows of constant elements.
RayBudget rays_of_rows(const MethodInput& input, const GlobalLight& light) {
    std::vector<Spectrum> reflected = leaf_reflectances(input.stage.scene, light.tree, light.numbering);
    for (std::size_t i = 0; i < reflected.size(); ++i) reflected[i] *= light.direct[i];
    RayBudget out = input.knobs.solve_rays;
    const double fewer = fewer_rays_in_crowd(input.stage, light.tree, light.numbering, reflected);
    out.average *= fewer, out.min = static_cast<unsigned>(fewer * out.min);
    return out;
}

/// Default resolution of a hemicube: about 200 times as many rays as a row has with random directions.
unsigned hemicube_cells(const MethodInput& input) {
    const double asked = input.options.hemicube_cells ? static_cast<double>(*input.options.hemicube_cells)
                                                      : 8 * std::sqrt(input.knobs.solve_rays.average);
    // The limit of 2 x 512 cells per edge is derived from the memory of a row.
    return 2 * static_cast<unsigned>(std::clamp(std::ceil(asked / 2), 1.0, 512.0));
}

HierarchyBasis galerkin_basis(BasisKind basis) {
    return basis == BasisKind::galerkin1   ? HierarchyBasis::haar
           : basis == BasisKind::galerkin2 ? HierarchyBasis::multiwavelet2
                                           : HierarchyBasis::multiwavelet3;
}

}  // namespace

/// Matrix radiosity [Goral84]: b = rho (E_dir + F b) on constant elements, solved by relaxation. The direct light of
/// emitters is exact and separate, so that b is reflected light only. Rows of F are found in one of these ways:
/// - cast by rays (single entries are noisy, gathered light is not; O(n) rays),
/// - computed, from elements to patches one level above them [Cohen86] (`--form-factors analytic`: O(n^2 / 4) entries
///   of 16 rays each),
/// - rendered by hemicubes [Cohen85].
///
/// With `--basis linear`, rows are cast from nodes and a ray evaluates the polynomial of the element that it hits
/// [Atkinson00]. With `--basis galerkin1` to `3`, blocks of the Galerkin matrix are integrated pair by pair [Zatz93].
GlobalLight solve_matrix(const MethodInput& input) {
    const Stage& stage = input.stage;
    const SolveOptions& options = input.options;
    if (options.bounces < 0 && options.basis && is_galerkin(*options.basis))
        return solve_galerkin(input, galerkin_basis(*options.basis));
    GlobalLight light{.tree = input.direct.tree, .numbering = LeafNumbering(input.direct.tree)};
    light.direct = leaf_means(input.direct, light.numbering);
    light.on_projection = true;

    input.progress.phase("link");
    if (options.basis == BasisKind::linear && options.bounces < 0) {
        solve_linear(input, light);
    } else if (options.form_factors.value_or(FormFactorKind::ray_cast) == FormFactorKind::ray_cast) {
        const ElementLocator locator(light.tree, stage.scene.regions().size());
        const RayRows F(stage, {light.tree, light.numbering, locator},
                        {rays_of_rows(input, light), options.seed, Dealing::by_element, RowsHeld::by_owner},
                        input.may_give_up ? &input.stop : nullptr);
        if (options.bounces < 0) light.kept = kept_light(F, stage);
        relax_constant_elements(input, F, light);
        light.work.rays = light.work.links = F.rays();
    } else if (*options.form_factors == FormFactorKind::hemicube) {
        const ElementLocator locator(light.tree, stage.scene.regions().size());
        const HemicubeRows F(stage, {light.tree, light.numbering, locator}, hemicube_cells(input));
        const PassedLight passed(stage.scene, light.tree, light.numbering.leaves);
        relax_constant_elements(input, PassingTransport(F, passed), light);
        light.work.rays = F.rays();
        light.work.links = light.work.form_factors = F.entries();
    } else {
        const PatchLevel patches(light.tree, light.numbering, 1);
        const auto samples = options.visibility_samples.value_or(default_visibility_samples);
        const PatchTransfer transfer(stage, light.tree, static_cast<unsigned>(samples), options.seed);
        const DenseTransport F(transfer, light.numbering, patches, input.progress, input.stop);
        const PassedLight passed(stage.scene, light.tree, light.numbering.leaves);
        relax_constant_elements(input, PassingTransport(F, passed), light);
        light.work.rays = transfer.rays();
        light.work.form_factors = transfer.form_factors();
        light.work.links = F.entries();
    }
    return light;
}

}  // namespace exitance
