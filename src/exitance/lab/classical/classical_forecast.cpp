#include <algorithm>

#include "exitance/lab/classical/classical.hpp"
#include "exitance/transport/patch_transfer.hpp"

namespace exitance {
namespace {

/// Rays that find the entries of `rows` rows of a matrix. `entries`: number of all pairs in them.
double rays_of_rows(const SolveOptions& options, const Knobs& knobs, double rows, double entries, double facing) {
    const double cells = hemicube_cells(options);
    switch (options.form_factors.value_or(FormFactorKind::analytic)) {
        case FormFactorKind::hemicube:
            return 3 * cells * cells * rows;  // the cells of the top and of four half sides
        case FormFactorKind::ray_cast:
            return ray_budget(options, knobs).average * rows;
        default:
            return facing * entries *
                   static_cast<double>(options.visibility_samples.value_or(default_visibility_samples));
    }
}

}  // namespace

RayBudget ray_budget(const SolveOptions& options, const Knobs& knobs) {
    RayBudget budget = knobs.solve_rays;
    if (options.visibility_samples) budget.average = static_cast<double>(*options.visibility_samples);
    return budget;
}

unsigned hemicube_cells(const SolveOptions& options) {
    const auto cells = std::min<std::size_t>(1024, options.hemicube_cells.value_or(default_hemicube_cells));
    return static_cast<unsigned>(2 * ((cells + 1) / 2));
}

double matrix_bytes(const SolveOptions& options, const Knobs& knobs, double n) {
    const double c = hemicube_cells(options), cells = 3 * c * c;
    switch (options.form_factors.value_or(FormFactorKind::analytic)) {
        case FormFactorKind::hemicube:
            return 8 * n * std::min(n, cells);
        case FormFactorKind::ray_cast:
            return 4 * n * ray_budget(options, knobs).average;
        default:
            return 4 * n * n;
    }
}

MethodForecast forecast_classical_matrix(const Stage& stage, const SolveOptions& options, const Knobs& knobs,
                                         double facing, bool) {
    const auto n = static_cast<double>(constant_mesh(stage, options, knobs, StopRequest()).leaves().size());
    return {.rays = rays_of_rows(options, knobs, n, n * n, facing),
            .bytes = matrix_bytes(options, knobs, n),
            .elements = n};
}

/// Every patch that receives light shoots at least once, and its column is kept for later shots.
MethodForecast forecast_classical_shooting(const Stage& stage, const SolveOptions& options, const Knobs& knobs,
                                           double facing, bool) {
    const auto patches = static_cast<double>(constant_mesh(stage, options, knobs, StopRequest()).leaves().size());
    const double elements = options.method == Method::substructuring ? 4 * patches : patches;
    return {.rays = rays_of_rows(options, knobs, patches, patches * elements, facing),
            .bytes = std::min(static_cast<double>(column_memory), 4 * patches * elements),
            .elements = elements};
}

}  // namespace exitance
