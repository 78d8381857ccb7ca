#include "exitance/methods/solver/standard_solver.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exitance/calibration/error_budget.hpp"
#include "exitance/evaluate/energy.hpp"
#include "exitance/evaluate/layer_elements.hpp"
#include "exitance/methods/light/discontinuity_light.hpp"
#include "exitance/methods/light/light_functions.hpp"
#include "exitance/methods/solve_report.hpp"

namespace exitance {

bool StandardSolver::makes_discontinuity_mesh() const {
    return options_.method == Method::discontinuity && !solution_.direct_in_elements;
}

bool StandardSolver::make_discontinuity() {
    progress_.phase("discontinuities");
    reach(Step::output);
    // With a time limit, coarse elements are computed first, so that there is a result when time runs out.
    const bool has_none = direct_.tree.size() == 0;
    if (has_none && std::isfinite(common_seconds_left(stop_))) {
        project_coarsely();
        progress_.phase("discontinuities");
    }
    SafePoints points = safe_points();
    const DiscontinuityReport report =
        add_discontinuity_mesh(stage_, options_, solution_, stop_, checkpoints_ ? &points : nullptr,
                               shows_layers_ ? show_layers() : ShowLayers());
    statistics().seconds[RunPart::mesh] += report.mesh_seconds;
    statistics().seconds[RunPart::direct] += report.direct_seconds;
    if (report.interrupted) stop_as_requested();
    const bool follows_shadows = !solution_.discontinuity.empty() || solution_.layers;
    if (follows_shadows) warn_of_lines();
    // The reported mesh must not depend on whether there was a time limit.
    if (follows_shadows && options_.bounces == 0 && !solution_.scene.has_light_from_outside()) direct_ = {};
    if (!follows_shadows && direct_.tree.size() == 0) project_coarsely();
    return follows_shadows;
}

ShowLayers StandardSolver::show_layers() const {
    return [this](const LightFormPointer& layers) {
        Solution shown = solution_;
        shown.layers = layers;
        SolveStatistics& s = shown.statistics;
        s.converged = false, s.relative_error_estimate.reset(), s.relative_error_bound.reset(), s.error_p99.reset();
        shown.interpolant = elements_of_layers(shown);
        shows_layers_(std::move(shown));
    };
}

void StandardSolver::warn_of_lines() {
    const DiscontinuityCounts& c = *statistics().discontinuity;
    const std::size_t followed = c.d0 + c.d1 + c.d2 + c.eee;
    const auto& lines = options_.discontinuity.lines;
    const bool are_chosen = lines && lines->kind != ShadowLines::Kind::automatic;
    if (are_chosen || c.left_out <= followed) return;
    warn(
        fmt::format("the mesh follows {} shadow lines; {} sources, edges and lines were left out, as they change the "
                    "light little or are too many (--dm-lines all leaves none out)",
                    followed, c.left_out));
}

double StandardSolver::interpolant_scale() const {
    return certificate_.mean_reflected > 0 ? certificate_.mean_reflected
                                           : mean_direct_light(stage_, direct_).of_errors();
}

ElementFunction StandardSolver::plain_elements(InterpolantReport& report, Progress* progress) const {
    const double error = options_.error_interpolant.value_or(ErrorBudget(options_.error_target()).exported_mesh());
    // Fits weigh errors by `light_weight`, which is not 1 on black surfaces.
    const bool is_black = !(certificate_.mean_reflected > 0) && !(mean_direct_light(stage_, direct_).reflected > 0);
    const double counted = interpolant_scale() * (is_black ? mean(light_weight(Material{})) : 1);
    return make_interpolant(
        stage_, direct_, solution_.indirect, solution_.direct_share,
        {.tolerance = error * counted, .light_in = rooms_.light_in(), .seed = options_.seed, .progress = progress},
        report, stop_);
}

void StandardSolver::make_exported_mesh() {
    if (stop_.requested() && light_is_dropped_at_stop()) {
        solution_.interpolant = dark(stage_);
        return;
    }
    const bool follows_shadows = makes_discontinuity_mesh() && make_discontinuity();
    progress_.phase("reconstruct");
    if (follows_shadows) {
        // The discontinuity mesh is exported.
    } else if (solution_.direct_in_elements) {
        solution_.interpolant = solution_.indirect;
        statistics().relative_error_estimate_interpolant = statistics().relative_error_estimate;
    } else {
        InterpolantReport report;
        solution_.interpolant = plain_elements(report, &progress_);
        const double scale = interpolant_scale();
        const double own = scale > 0 ? report.error / scale : 0;
        if (statistics().relative_error_estimate && !report.interrupted)
            statistics().relative_error_estimate_interpolant = std::hypot(own, *statistics().relative_error_estimate);
        progress_.note(fmt::format("{} elements to export; their own error is {:.3f}%",
                                   solution_.interpolant.tree.leaves().size(), 100 * own));
    }
}

void StandardSolver::record_energy() {
    if (stop_.requested() && light_is_dropped_at_stop()) return;
    Solver::record_energy();
    EnergyBalance& energy = statistics().energy;
    energy.defect_before = energy_defect_before(energy, solution_, direct_, unscaled_);
}

}  // namespace exitance
