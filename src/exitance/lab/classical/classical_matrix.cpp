#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "exitance/base/available_memory.hpp"
#include "exitance/base/memory.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/lab/classical/classical.hpp"
#include "exitance/solve/dense_relaxation.hpp"
#include "exitance/transport/hemicube_rows.hpp"
#include "exitance/transport/patch_transfer.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {
namespace {

constexpr double default_sor_factor = 1.15;  // radiosity converges fastest with 1.1 to 1.2 [Gortler94]

/// Solves b = rhs + rho F b by the requested relaxation. Calls `swept` after every sweep.
SolveReport relax(const MethodInput& input, const RadiositySystem& system, std::vector<Spectrum>& b,
                  const std::function<void()>& swept) {
    const StopRule stop{
        .residual = input.knobs.residual, .max_iterations = input.knobs.max_iterations, .request = &input.stop};
    const auto& c = input.options.classical;
    if (c.relaxation == ClassicalRelaxation::direct) return solve_dense(system, b, input.stop);
    const Relaxation asked = input.options.relaxation.value_or(Relaxation::gauss_seidel);
    if (c.relaxation == ClassicalRelaxation::sor)
        return relax_in_turn(system, c.sor_factor.value_or(default_sor_factor), b, stop, swept);
    if (asked == Relaxation::gauss_seidel) return relax_in_turn(system, 1, b, stop, swept);
    if (asked == Relaxation::jacobi) return relax_at_once(system, b, stop, swept);
    if (asked == Relaxation::southwell) return relax_largest_residual(system, b, stop, swept);
    return solve_radiosity(system, asked, b, stop);
}

/// Solves for b and evaluates E = F b.
void solve_with(const MethodInput& input, const ElementTree& tree, const LeafNumbering& numbering,
                const TransportOperator& F, GlobalLight& light) {
    input.progress.phase("solve");
    const std::size_t n = numbering.leaves.size();
    const std::vector<double> area = leaf_areas(tree, numbering);
    const std::vector<Spectrum> rho = leaf_reflectances(input.stage.scene, tree, numbering);
    std::vector<Spectrum> rhs = carries_light(input) ? exitances(input, tree, numbering.leaves)
                                                     : mean_direct_light(input, tree, numbering.leaves);
    if (!carries_light(input))
        for (std::size_t i = 0; i < n; ++i) rhs[i] *= rho[i];
    std::vector<Spectrum> b = rhs, E(n);
    light.work.link_memory_bytes = F.memory_bytes();
    light.published->figures["coefficient_memory_bytes"] =
        static_cast<double>(3 * n * sizeof(Spectrum));  // memory of b, E and the source term
    std::size_t rounds = 0;
    const auto light_so_far = [&] {
        F.gather(b, E);
        light.published->irradiance = constant_function(tree, numbering.leaves, E);
        light.report.iterations = rounds;
        return light;
    };
    const auto swept = [&] { ++rounds, input.end_round(light_so_far); };
    const SolveReport report = relax(input, {F, rho, rhs, area}, b, swept);
    light_so_far();
    light.report = report;
}

/// Returns an error if the matrix of n leaves does not fit into the memory limit, or into available memory.
Result<void> check_memory(const MethodInput& input, double n) {
    const double bytes = matrix_bytes(input.options, input.knobs, n);
    const auto used = static_cast<double>(peak_memory_bytes()),
               limit = static_cast<double>(
                   input.options.memory_limit_bytes.value_or(resident_memory_bytes() + available_memory_bytes()));
    if (used + bytes <= limit) return {};
    return Error{
        ErrorCode::limit,
        fmt::format("{:.0f} MiB are in use and the matrix of {:.0f} elements takes up to {:.0f} MiB more, over "
                    "the {:.0f} MiB there are",
                    used / 0x1p20, n, bytes / 0x1p20, limit / 0x1p20),
        "--method matrix", "a larger --mesh-size, more --memory-limit, or a method with links"};
}

}  // namespace

/// The matrix method as in [Goral84], [Cohen85] and [Cohen86]: constant elements, and all N x N form factors at once.
/// - `analytic` (default): from the receiver's centre to the whole source polygon, times the unblocked share of rays
///   between them, without a level of patches. This is the reference among the methods.
/// - `hemicube`, `ray-cast`: rows of hemicubes or rays.
///
/// O(N^2) entries.
GlobalLight solve_classical_matrix(const MethodInput& input) {
    GlobalLight light = published_light(input);
    input.progress.phase("mesh");
    const ElementTree tree = constant_mesh(input.stage, input.options, input.knobs, input.stop);
    const LeafNumbering numbering(tree);
    light.published->elements = tree.size(), light.published->leaf_elements = numbering.leaves.size();
    input.progress.phase("link");
    const Stage& stage = input.stage;
    const SolveOptions& o = input.options;
    const FormFactorKind kind = o.form_factors.value_or(FormFactorKind::analytic);
    if (const Result<void> fits = check_memory(input, static_cast<double>(numbering.leaves.size())); !fits) {
        light.published->refusal = fits.error();
        return light;
    }
    if (kind == FormFactorKind::analytic) {
        const PatchLevel patches(tree, numbering, 0);
        const PatchTransfer transfer(
            stage, tree, static_cast<unsigned>(o.visibility_samples.value_or(default_visibility_samples)), o.seed);
        const DenseTransport F(transfer, numbering, patches, input.progress, input.stop);
        solve_with(input, tree, numbering, F, light);
        light.work.rays = transfer.rays(), light.work.form_factors = transfer.form_factors(),
        light.work.links = F.entries();
        return light;
    }
    const ElementLocator locator(tree, stage.scene.regions().size());
    if (kind == FormFactorKind::hemicube) {
        const HemicubeRows F(stage, {tree, numbering, locator}, hemicube_cells(o));
        solve_with(input, tree, numbering, F, light);
        light.work.rays = F.rays(), light.work.form_factors = light.work.links = F.entries();
        return light;
    }
    const RayRows F(stage, {tree, numbering, locator}, {ray_budget(input.options, input.knobs), o.seed});
    solve_with(input, tree, numbering, F, light);
    light.work.rays = light.work.links = F.rays();
    return light;
}

}  // namespace exitance
