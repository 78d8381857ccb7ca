#include "exitance/methods/solver/published_solver.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "exitance/base/distinct_numbers.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/evaluate/energy.hpp"
#include "exitance/methods/light/light_functions.hpp"
#include "exitance/methods/light/vertex_averages.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/methods/solve_report.hpp"
#include "exitance/solve/growth_watch.hpp"

namespace exitance {
namespace {

/// Zero light on the leaves of a tree.
DirectProjection no_direct_light(const ElementTree& tree) {
    return {.tree = tree, .fit = Field<ElementId, DirectFit>(tree.size())};
}

/// Mean light reflected by E plus direct light on its leaves, W/m^2.
double mean_reflected(const Stage& stage, const ElementFunction& E, const DirectProjection& direct) {
    double flux = 0;
    for (ElementId e : E.tree.leaves()) {
        const Spectrum all = E.at({e, E.tree.centre(e)}) + direct.fit[e].mean;
        flux += E.tree.area(e) * mean(stage.scene.material(E.tree.region(e)).reflectance * all);
    }
    return flux / stage.area;
}

/// All light: E plus direct light on the same elements.
ElementFunction with_direct(const ElementFunction& E, const DirectProjection& direct) {
    ElementFunction out;
    out.tree = E.tree;
    out.first_value.resize(out.tree.size(), 0);
    for (ElementId e : out.tree.leaves()) {
        out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
        const Patch& patch = out.tree.patch(e);
        for (int k = 0; k < 4; ++k)
            out.add_value(E.at({e, patch.corner_uv(std::min(k, patch.corner_count() - 1))}) +
                          direct.fit[e].corners[static_cast<std::size_t>(k)]);
    }
    return out;
}

/// Records the counts of a published form, which replace those of the certificate's mesh.
void record_counts(const PublishedLight& light, SolveStatistics& s) {
    s.elements = light.elements, s.leaf_elements = light.leaf_elements;
    s.discontinuity = light.counts;
    s.seconds[RunPart::visibility] = light.visibility_seconds;
    s.seconds[RunPart::form_factors] = light.form_factor_seconds;
    for (const auto& [name, value] : light.figures) s.figures[name] = value;
}

}  // namespace

void PublishedSolver::find_light() {
    const std::optional<double> demand = this->demand();
    if (attempt_ == 1) aim_ = demand.value_or(options_.error_target());
    snapshots_.emplace(options_.snapshots, [this](const Snapshots::Moment& moment) { show_snapshot(moment); });
    make_attempts(demand);
    warn_of_rooms();
    warn_of_bodies();
}

void PublishedSolver::make_attempts(std::optional<double> demand) {
    for (;; ++attempt_, reach(Step::project)) {
        const Stopwatch watch;
        attempt();
        if (refusal_ || !has_estimate(options_) || statistics().is_stopped()) return;
        certify_carried_light();
        if (stop_.requested()) return stop_as_requested();
        statistics().converged = !demand || certificate_.largest() <= *demand;
        if (statistics().converged) return;
        snapshots_->after_round([this] { return *light_; });
        if (!aim_lower(*demand, watch.seconds())) return;
    }
}

void PublishedSolver::attempt() {
    if (step_ == Step::project) {
        run_method(aim_, &*snapshots_);
        progress_.close();
        double& solving = statistics().seconds[RunPart::solve];
        solving = std::max(0.0, solving - snapshots_->writing());
        if ((refusal_ = light_->published->refusal)) return;
        record_end();
        if (gives_up()) return stop_as_requested();
        take_light(*light_, solution_);
        reach(Step::gather);
    }
    if (step_ == Step::gather) {
        const bool gathers = form_of(options_) == Form::published && options_.classical.gather.value_or(true);
        if (gathers && stage_.has_indirect_light() && !stop_.requested()) solution_.indirect = gather_once();
        record_method_time(snapshots_->seconds(), snapshots_->processor_seconds(), statistics());
        reach(Step::certify);
    }
}

bool PublishedSolver::aim_lower(double demand, double last_seconds) {
    // About four times as many links and nodes are needed to halve the error.
    constexpr double cost_of_finer = 4, min_factor = 0.5;
    if (attempt_ == attempt_limit()) return stop_early(StopReason::iterations), false;
    if (common_seconds_left(stop_) < cost_of_finer * last_seconds) {
        record_missing_time(cost_of_finer * last_seconds);
        return stop_early(StopReason::time_limit), false;
    }
    aim_ *= std::max(min_factor, calibrated::part_aim * demand / certificate_.largest());
    const NumberTexts percents = distinct_percents(certificate_.largest(), demand);
    progress_.note(fmt::format("estimated error {}% > {}%: solving again for {:.3g}%", percents.first, percents.second,
                               100 * aim_));
    return true;
}

std::optional<double> PublishedSolver::demand() const {
    const std::optional<double> demand = options_.error_demand();
    if (!options_.error_interpolant) return demand;
    return std::min(*options_.error_interpolant, demand.value_or(HUGE_VAL));
}

void PublishedSolver::record_end() {
    const SolveReport& report = light_->report;
    if (light_->limited_by_memory) stop_early(StopReason::memory_limit);
    if (report.interrupted)
        stop_as_requested();
    else if (has_diverged(report))
        stop_early(StopReason::divergence);
    else if (!report.converged && !options_.max_iterations && !statistics().is_stopped())
        stop_early(StopReason::iterations);
}

void PublishedSolver::take_light(const GlobalLight& light, Solution& solution) const {
    const PublishedLight& found = *light.published;
    solution.indirect = found.irradiance.tree.size() > 0 ? found.irradiance : on_leaves(light);
    solution.direct_in_elements = light.holds_direct();
    solution.discontinuity = found.mesh;
    record_method(stage_, light, has_links_, solution.statistics);
    record_counts(found, solution.statistics);
}

void PublishedSolver::record_method_time(double seconds, double processor_seconds, SolveStatistics& s) const {
    s.figures["method_seconds"] = seconds;
    s.figures["processor_seconds"] = processor_seconds;
}

ElementFunction PublishedSolver::gather_once() {
    progress_.phase("gather");
    const ElementFunction& E = solution_.indirect;
    const bool is_carried = solution_.direct_in_elements;
    const DirectProjection direct = is_carried ? no_direct_light(E.tree) : direct_light_on(stage_, E.tree);
    const Spectrum one(1.0), none;
    const DeliveredLight b(stage_.scene, E, direct, is_carried ? none : one, is_carried ? one : none);
    if (!local_pass_) local_pass_.emplace(stage_, knobs_.gather_mesh, options_.seed);
    ElementFunction out = local_pass_->gather(b, true, gather_demand(mean_reflected(stage_, E, direct)), gathered_,
                                              progress_, stop_, safe_points());
    statistics().rays += gathered_.rays;
    return out;
}

void PublishedSolver::certify_carried_light() {
    progress_.phase("certify");
    direct_ = no_direct_light(light_->tree);
    rooms_.allow_by_light();
    certify({.error = options_.error_target(), .seed = options_.seed});
    record_counts(*light_->published, statistics());
}

void PublishedSolver::show_snapshot(const Snapshots::Moment& moment) {
    if (!show_) return;
    Solution shown{.scene = solution_.scene, .statistics = statistics()};
    // in later steps the work has been recorded already
    if (step_ == Step::project) record_work(moment.light, shown.statistics);
    take_light(moment.light, shown);
    make_mesh(shown);
    shown.statistics.converged = false;
    shown.statistics.seconds[RunPart::total] = moment.seconds;
    record_method_time(moment.seconds, moment.processor_seconds, shown.statistics);
    show_(std::move(shown));
}

DirectProjection PublishedSolver::make_mesh(Solution& solution) const {
    constexpr double nearness = 1e-6;  // derived from rounding: corners at this share of the scene's size are equal
    ElementFunction& E = solution.indirect;
    if (options_.smoothing.value_or(false) && form_of(options_) == Form::published)
        E = averaged_at_vertices(E, nearness * stage_.scene.size());
    DirectProjection direct;
    if (!solution.direct_in_elements) direct = direct_light_on(stage_, E.tree);
    solution.interpolant = solution.direct_in_elements ? E : with_direct(E, direct);
    return direct;
}

void PublishedSolver::make_exported_mesh() {
    progress_.phase("reconstruct");
    direct_ = make_mesh(solution_);
    statistics().relative_error_estimate_interpolant = statistics().relative_error_estimate;
}

void PublishedSolver::record_energy() {
    Solver::record_energy();
    const EnergyBalance& energy = statistics().energy;
    // The defect is the mean error of the absorbed light, relative to the emitted light, and thus at most its RMS
    // error.
    if (has_estimate(options_) || options_.bounces >= 0 || stop_.requested() || statistics().is_stopped() ||
        energy.defect <= options_.error_target())
        return;
    const bool is_missing = energy.absorbed + energy.escaped < energy.emitted;
    warn(
        fmt::format("the light is wrong by {:.3g}% in the mean: so much of the emitted power {}; the settings of the "
                    "published form do not suit this scene, and finer ones help (--threshold, --min-area, "
                    "--mesh-size, --residual)",
                    100 * energy.defect, is_missing ? "is neither absorbed nor escapes" : "is absorbed in excess"));
}

}  // namespace exitance
