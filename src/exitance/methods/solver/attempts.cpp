#include "exitance/methods/solver/standard_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "exitance/base/distinct_numbers.hpp"
#include "exitance/base/memory.hpp"
#include "exitance/calibration/error_budget.hpp"
#include "exitance/error/direct_light_noise.hpp"
#include "exitance/evaluate/energy.hpp"
#include "exitance/methods/light/corrected_sums.hpp"
#include "exitance/methods/plan/attempt_forecast.hpp"
#include "exitance/methods/plan/memory_plan.hpp"
#include "exitance/methods/solve_archive.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/solution/continuous.hpp"
#include "exitance/solve/growth_watch.hpp"

namespace exitance {

StandardSolver::StandardSolver(Scene scene, const SolveOptions& asked, Progress& progress, const StopRequest& stop,
                               CheckpointStore* checkpoints, const ShowLight& show, ShowLight shows_layers)
    : Solver(std::move(scene), asked, progress, stop, checkpoints, show), shows_layers_(std::move(shows_layers)) {
    requested_error_ = options_.error_target();
    if (show && options_.error_demand()) options_.error = std::max(recognizable_error, requested_error_);
}

template <class Archive>
void StandardSolver::archive_attempts(Archive& a) {
    a(fresh_, share_, unscaled_, corrected_, steps_);
    next_.archive_state(a);
    body_demand_.archive_state(a);
}

void StandardSolver::archive_own(ArchiveReader& a) {
    archive_attempts(a);
}

void StandardSolver::archive_own(ArchiveWriter& a) {
    archive_attempts(a);
}

Result<void> StandardSolver::fit_memory() {
    if (!options_.memory_limit_bytes) return {};
    const Result<bool> fits = fit_into_memory(knobs_, stage_, options_);
    if (!fits) return fits.error();
    if (!*fits) stop_early(StopReason::memory_limit);
    return {};
}

void StandardSolver::find_light() {
    const bool reflects = options_.bounces != 0 && stage_.has_indirect_light();
    if (!reflects) return solve_direct_light();
    solve_indirect_light();
    warn_of_rooms();
    warn_of_bodies();
}

void StandardSolver::solve_direct_light() {
    if (!makes_discontinuity_mesh() || solution_.scene.has_light_from_outside()) project_direct();
    statistics().elements = direct_.tree.size();
    statistics().leaf_elements = direct_.tree.leaves().size();
    record_zero_error();
    record_noise_of_direct_light_alone();
}

void StandardSolver::record_noise_of_direct_light_alone() {
    const double error = direct_light_noise(stage_, direct_, point_accuracy(1));
    if (error > 0)
        statistics().relative_error_estimate = statistics().relative_error_bound =
            error / mean_direct_light(stage_, direct_).of_errors();
}

void StandardSolver::solve_indirect_light() {
    for (;; ++attempt_, step_ = Step::project) {
        const Stopwatch watch;
        attempt();
        if (refusal_) return;
        if (stop_.requested()) return stop_as_requested();
        const bool is_lowered = show_ && options_.error_demand() && lower_error();
        const std::optional<double> demand = options_.error_demand();
        if (!demand || has_reached(*demand)) {
            if (has_diverged(light_->report)) return stop_early(StopReason::divergence);
            if (demand && refines_bodies(*demand, watch.seconds())) continue;
            if (!statistics().is_stopped() || demand)
                statistics().converged = true, statistics().stopped_by = StopReason::none;
            return;
        }
        if (light_->limited_by_memory) stop_early(StopReason::memory_limit);
        if (statistics().stopped_by == StopReason::memory_limit) return;
        // Growing cells deliver the light of their units. With as many units as before, another attempt would only
        // refine elements on which that light does not depend.
        const bool has_all_units = options_.method == Method::growing_cells && options_.max_units;
        if (has_all_units && (!gathers() || light_->holds_direct())) return stop_early(StopReason::unit_limit);
        if (attempt_ == attempt_limit()) return stop_early(StopReason::iterations);
        if (show_) show_light();
        std::optional<NextAttempt> next = next_in_time(*demand, watch.seconds());
        // Far from the target error, a new plan for it is faster than refinement steps, each of which leaves about half
        // of the error.
        if (is_lowered) next = NextAttempt{.finer = {.knobs = first_knobs(plan_, stage_, *demand), .method = true}};
        if (!next) {
            record_missing_time(next_attempt(*demand).finer.work * as_first(watch.seconds()));
            return stop_early(StopReason::time_limit);
        }
        if (!next->forecast.empty()) progress_.note(next->forecast);
        progress_.note(fmt::format("{}: {}", reason_for_attempt(*demand),
                                   next->is_step        ? "refining the delivered elements"
                                   : next->finer.method ? "solving again with finer elements"
                                                        : "refining the gather; the method's light is kept"));
        rooms_.keep_noise_of_accurate(statistics().rooms, stage_.rooms.count(), certificate_.estimate,
                                      ErrorBudget(*demand).next_attempt(),
                                      next->finer.knobs.gather_noise / knobs_.gather_noise);
        knobs_ = next->finer.knobs, starts_with_step_ = next->is_step;
        if (next->finer.method && !starts_with_step_) solve_again();
        if (options_.memory_limit_bytes) {
            const Result<bool> fits = fit_into_memory(knobs_, stage_, options_);
            if (!fits || !*fits) return stop_early(StopReason::memory_limit);
        }
    }
}

std::string StandardSolver::reason_for_attempt(double demand) const {
    const double found = certificate_.largest();
    const NumberTexts percents = distinct_percents(found, demand);
    if (found > demand) return fmt::format("estimated error {}% > {}%", percents.first, percents.second);
    return fmt::format("estimated error {}%, uncertain by {:.2f}%, is too close to {}%", percents.first,
                       100 * certificate_.largest_uncertainty(), percents.second);
}

void StandardSolver::attempt() {
    if (step_ == Step::project) {
        fresh_ = !light_;
        if (fresh_) project_direct();
        if (fresh_ && !has_memory()) return;
        if (starts_with_step_) take_two_grid_step();
        if (stop_.requested()) return;  // no earlier attempt has light: return direct light only
        reach(Step::solve);
    }
    if (step_ == Step::solve) {
        find_method_light();
        if (gives_up()) return;
        reach(Step::gather);
    }
    if (step_ == Step::decide) return;
    NextLight found;
    if (next_.parts.empty()) found.parts.push_back(gathered_light(stage_.scene, direct_, *light_, share_));
    for (const ElementFunction& f : found.parts) share_on_node(std::span(f.values));
    const NextLight& gathered_on = next_.parts.empty() ? found : next_;
    steps_.sent =
        gathers() && keeps_flux() ? arriving_power(stage_.scene, lost_light(), gathered_on.parts) : Spectrum();
    ReadNextLight b(gathered_on, stage_.scene.regions().size());
    if (gathers() && !sums_) bright_ = find_bright_places(stage_, direct_.tree, b.whole()), b.aim_at(bright_);
    if (b.stands_alone() && !sums_) found = {};
    release_freed_memory();
    if (step_ == Step::gather) {
        corrected_.clear();
        const bool whole = deliver(parts_to_sum(found.parts), b, fresh_);
        if (!whole) return;
        next_.rest.clear();  // this light has been gathered
        steps_.gather_rays = std::max(steps_.gather_rays, gathered_.rays);
        reach(Step::correct_sums);
    }
    if (step_ == Step::correct_sums && corrects_sums()) {
        if (corrected_.empty())
            corrected_ = corrected_sums(refinement_of(solution_.indirect), knobs_.gather_element_share);
        const bool whole = deliver(parts_to_sum(corrected_), b, true);
        if (!whole) return;
    }
    reach(Step::certify);
    const std::vector<ElementGather> elements = corrects_sums() ? parts_to_sum(corrected_) : parts_to_sum(found.parts);
    progress_.phase("certify");
    CertificateOptions look{.error = options_.error_target(),
                            .seed = certificate_seed(),
                            .points = CertificateOptions::points_for(elements_of_continuous(solution_.indirect.tree))};
    if (sums_) look.points /= 2;  // half as many points suffice, since sums have no noise
    if (gathers()) look.leaves = &gathered_.leaves, look.gathered = &b.whole();
    look.coarse = &b.method_mesh();
    certify(look, options_.error_demand(), elements);
    reach(Step::decide);
}

std::uint64_t StandardSolver::certificate_seed() const {
    const auto attempts_before = static_cast<std::uint64_t>(attempt_ - 1 + attempts_before_);
    return attempts_before == 0 ? options_.seed : hash(options_.seed, attempts_before);
}

/// Returns the parts of the error where it is largest. If their sum exceeds the whole error, they cancel in part, as
/// after several refinement steps; they are then scaled down to the whole. Misfit that is hidden by the rays' noise
/// counts as noise, since a smaller tolerance would not split any elements. Where near surfaces reflect errors to each
/// other, the parts are scaled up to the whole. Error at rough places counts as neither:
/// the local pass refines these in any case.
ErrorParts StandardSolver::error_parts() const {
    if (!gathers()) return {.method = certificate_.largest()};
    const std::optional<std::size_t> room = certificate_.largest_room;
    const LocalPassReport::Parts told =
        room && *room < gathered_.rooms.size() ? gathered_.rooms[*room] : gathered_.whole;
    const double parts = std::hypot(certificate_.local, certificate_.method), all = certificate_.largest();
    const double scale = parts > 0 ? std::min(certificate_.again, all / parts) : certificate_.again;
    const double spread = std::sqrt(std::max(0.0, std::pow(certificate_.local, 2) - std::pow(certificate_.rough, 2)));
    const double local = scale * spread, noise = certificate_.again * told.noise / certificate_.largest_light;
    const double misfit = std::sqrt(std::max(0.0, local * local - noise * noise));
    const double seen = certificate_.again * told.interpolation / certificate_.largest_light;
    // If the misfit exceeds the detected interpolation error by this factor, the rays' noise hides it.
    constexpr double min_hidden_ratio = 3;
    return {.method = scale * certificate_.method,
            .noise = misfit > min_hidden_ratio * seen ? std::max(noise, misfit) : noise,
            .interpolation = std::max(misfit, seen)};
}

double StandardSolver::not_local(const ErrorParts& parts) const {
    const double all = certificate_.largest(), local = std::hypot(parts.noise, parts.interpolation);
    return std::max(parts.method, std::sqrt(std::max(0.0, all * all - local * local)));
}

bool StandardSolver::refines_bodies(double demand, double last_seconds) {
    const double limit = ErrorBudget(demand).body(), worst = certificate_.worst_body.value_or(0);
    if (!holds_bodies() || !gathers() || sums_ || !body_demand_.needs_attempt(statistics().bodies, worst, limit) ||
        attempt_ == attempt_limit() || is_intermediate())
        return false;
    if ((lacked_time_ = as_first(last_seconds) > common_seconds_left(stop_))) return false;
    // A refinement step keeps sufficiently accurate results. Next to near surfaces, it replaces the method's elements
    // by the delivered ones, which are finer there. Errors of the direct light that bodies see need a new solve.
    const bool is_first = body_demand_.begin_attempt(worst);
    starts_with_step_ = is_first && plan_.may_step_on_delivered && light_->on_projection;
    body_demand_.tighten(statistics().bodies, bodies(), limit,
                         starts_with_step_ ? BodyDemand::Cause::gathered : BodyDemand::Cause::seen);
    if (!starts_with_step_) solve_again();
    const NumberTexts percents = distinct_percents(worst, limit);
    progress_.note(fmt::format("estimated error {}% of the worst body > {}%: {}", percents.first, percents.second,
                               starts_with_step_ ? "refining the delivered elements"
                                                 : "solving again with finer elements where such bodies see them"));
    return true;
}

bool StandardSolver::lower_error() {
    // Factor on the error between intermediate solutions, given by work ~ error^-2.5 to error^-1. Solutions that differ
    // less are not worth an attempt.
    constexpr double step = 0.4;
    const double before = *options_.error;
    while (*options_.error > requested_error_ && has_reached(*options_.error)) {
        const double next = step * std::min(*options_.error, certificate_.largest());
        options_.error = step * next <= requested_error_ ? requested_error_ : next;
    }
    if (*options_.error == before) return false;
    ++attempts_before_;
    if (!has_reached(*options_.error)) return true;
    step_ = Step::certify;
    attempt();
    return false;
}

void StandardSolver::show_light() {
    Solution shown = solution_;
    InterpolantReport report;
    shown.interpolant = shown.direct_in_elements ? shown.indirect : plain_elements(report);
    shown.statistics.energy = energy_balance(shown, direct_, stage_);
    shown.statistics.converged = false;
    show_(std::move(shown));
}

std::optional<StandardSolver::NextAttempt> StandardSolver::next_in_time(double demand, double last_seconds) const {
    // An attempt that cannot finish in time would be discarded. All processes use the first one's clock.
    const double max_work = common_seconds_left(stop_) / as_first(last_seconds);
    for (const double aim : attempt_aims(demand, certificate_.largest())) {
        NextAttempt next = next_attempt(aim);
        if (next.finer.work <= max_work) return next;
    }
    return {};
}

StandardSolver::NextAttempt StandardSolver::next_attempt(double demand) const {
    const double target = ErrorBudget(demand).next_attempt();
    const double all = judged_error(), rough = certificate_.rough;
    if (all * all - rough * rough <= target * target) return {.finer = {.knobs = knobs_}};
    const ErrorParts parts = error_parts();
    NextAttempt out{.finer = tightened(knobs_, parts, target, options_)};
    const Tightened& finer = out.finer;
    if (!finer.method || !plan_.may_step_on_delivered || !gathers() || !light_->on_projection) return out;
    // A refinement step leaves about a third of the error at first, more if light is reflected often. The first step
    // measures it.
    const double left = steps_.not_local > 0 ? not_local(parts) / steps_.not_local : 0.5;
    const AttemptForecast forecast = forecast_attempt({.row_rays = static_cast<double>(light_->work.rays),
                                                       .gather_rays = static_cast<double>(steps_.gather_rays),
                                                       .certificate_rays = static_cast<double>(certificate_.rays),
                                                       .method = not_local(parts),
                                                       .wanted = ErrorBudget::method_share * target,
                                                       .left = left,
                                                       .finer = finer.left});
    out.is_step = forecast.takes_steps();
    out.forecast =
        fmt::format("another attempt: about {:.3g} rays by refining the delivered elements, {:.3g} by finer elements",
                    forecast.step_rays, forecast.finer_rays);
    if (out.is_step)
        out.finer = tightened_for_step(knobs_, parts, left, margin(certificate_.points) * demand, target, options_);
    return out;
}

}  // namespace exitance
