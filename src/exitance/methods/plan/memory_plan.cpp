#include "exitance/methods/plan/memory_plan.hpp"

#include <fmt/format.h>

#include "exitance/calibration/numbers.hpp"
#include "exitance/core/memory.hpp"
#include "exitance/transport/distributed.hpp"

namespace exitance {
namespace {

/// Leaves of an element that is predicted, refinements and grading included; on rooms of 10^2 to 10^5 polygons, rounded
/// up.
constexpr double leaves_an_element = 4;

/// What processes of one node hold together, by what one would hold alone: each has `own` of it for itself.
double share_of_process(double own) {
    const auto count = static_cast<double>(processes_on_node());
    return (1 + own * (count - 1)) / count;
}

/// What a process holds now: what those of a node have in common counts for each by its share.
double bytes_in_use() {
    const std::size_t proportional = processes() > 1 ? proportional_memory_bytes() : 0;
    const double own = static_cast<double>(proportional > 0 ? proportional : peak_memory_bytes());
    return largest_of_all(sum_on_node(own) / static_cast<double>(processes_on_node()));
}

double predicted_bytes(const Knobs& knobs, const std::vector<Piece>& pieces, const SolveOptions& options) {
    const auto elements = static_cast<double>(predict_elements(pieces, knobs.solve_mesh.edge) +
                                              predict_elements(pieces, knobs.gather_mesh.edge));
    const bool galerkin = options.basis && is_galerkin(*options.basis);
    // Links while they are sorted; entries with their sources. Half of all pairs see each other.
    const double words_a_pair = galerkin                                           ? 15
                                : options.form_factors == FormFactorKind::hemicube ? 2
                                : options.form_factors == FormFactorKind::analytic ? 1
                                                                                   : 0;
    const double entries =
        words_a_pair > 0 ? words_a_pair * elements * elements : 4 * elements * knobs.solve_rays.average;
    const double of_all = bytes_a_leaf * leaves_an_element * elements + 4 * entries;
    return largest_of_all(share_of_process(own_memory)) * of_all;
}

}  // namespace

Result<bool> fit_into_memory(Knobs& knobs, const std::vector<Piece>& pieces, const SolveOptions& options) {
    const double limit = static_cast<double>(*options.memory_limit_bytes);
    const double used = bytes_in_use();
    bool unchanged = true;
    for (double before = 0; used + predicted_bytes(knobs, pieces, options) > limit; unchanged = false) {
        const double now = predicted_bytes(knobs, pieces, options);
        if (now == before)
            return Error{
                ErrorCode::limit,
                fmt::format("{:.0f} MiB are in use and the coarsest mesh needs about {:.0f} MiB more, over the "
                            "limit of {:.0f} MiB",
                            used / 0x1p20, now / 0x1p20, limit / 0x1p20),
                "--memory-limit", "raise the limit"};
        before = now;
        knobs.solve_mesh.edge *= calibrated::coarsening;
        knobs.gather_mesh.edge *= calibrated::coarsening;
        knobs.solve_mesh.grading_levels = std::max(0, knobs.solve_mesh.grading_levels - 1);
        knobs.gather_mesh.grading_levels = std::max(0, knobs.gather_mesh.grading_levels - 1);
        knobs.solve_rays.average = std::max(calibrated::least_rays, knobs.solve_rays.average / calibrated::coarsening);
    }
    return unchanged;
}

}  // namespace exitance
