#include "exitance/methods/solver/solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "exitance/base/memory.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/evaluate/energy.hpp"
#include "exitance/methods/light/corrected_sums.hpp"
#include "exitance/methods/light/smoothing.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/methods/plan/attempt_forecast.hpp"
#include "exitance/methods/plan/memory_plan.hpp"
#include "exitance/methods/plan/method_memory.hpp"
#include "exitance/methods/solve_report.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/solution/continuous.hpp"
#include "exitance/solve/conserving_transport.hpp"
#include "exitance/solve/direct_share.hpp"
#include "exitance/solve/growth_watch.hpp"
#include "exitance/transport/body_views.hpp"
#include "exitance/transport/narrow_places.hpp"

namespace exitance {

void Solver::solve_indirect_light() {
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
        if (!next) return stop_early(StopReason::time_limit);
        if (!next->forecast.empty()) progress_.note(next->forecast);
        progress_.note(fmt::format("estimated error {:.2f}% > {:.2f}%: {}", 100 * certificate_.largest(), 100 * *demand,
                                   next->is_step        ? "refining the delivered elements"
                                   : next->finer.method ? "solving again with finer elements"
                                                        : "refining the gather; the method's light is kept"));
        keep_noise_of_accurate_rooms(calibrated::attempt_aim * *demand,
                                     next->finer.knobs.gather_noise / knobs_.gather_noise);
        knobs_ = next->finer.knobs, starts_with_step_ = next->is_step;
        if (next->finer.method && !starts_with_step_) light_.reset(), next_ = {}, steps_.not_local = 0;
        if (options_.memory_limit_bytes) {
            const Result<bool> fits = fit_into_memory(knobs_, stage_, options_);
            if (!fits || !*fits) return stop_early(StopReason::memory_limit);
        }
    }
}

bool Solver::refines_bodies(double demand, double last_seconds) {
    // One attempt is made for bodies, or two if the first one halved the excess error. Others would cost more than the
    // whole solve, for the sake of bodies whose errors are uncertain themselves.
    constexpr int max_for_bodies = 2;
    // Errors that are above the limit only by their noise are no reason for another attempt.
    const double limit = max_body_errors * demand, worst = certificate_.worst_body.value_or(0);
    const bool is_above = std::any_of(statistics().bodies.begin(), statistics().bodies.end(),
                                      [&](const BodyError& body) { return body.error && body.at_least > limit; });
    const bool helps = worst_body_before_ == 0 || worst - limit < 0.5 * (worst_body_before_ - limit);
    if (!holds_bodies() || !gathers() || sums_ || !is_above || !helps || body_attempts_ == max_for_bodies ||
        attempt_ == attempt_limit() || (options_.error && *options_.error > requested_error_) ||
        as_first(last_seconds) > common_seconds_left(stop_))
        return false;
    ++body_attempts_, worst_body_before_ = worst;
    // A refinement step keeps sufficiently accurate results. Next to near surfaces, it replaces the method's elements
    // by the delivered ones, which are finer there. Errors of the direct light that bodies see need a new solve.
    starts_with_step_ = body_attempts_ == 1 && plan_.may_step_on_delivered && light_->on_projection;
    tighten_bodies(limit);
    if (!starts_with_step_) light_.reset(), next_ = {}, steps_.not_local = 0;
    progress_.note(fmt::format("estimated error {:.2f}% of the worst body > {:.2f}%: {}", 100 * worst, 100 * limit,
                               starts_with_step_ ? "refining the delivered elements"
                                                 : "solving again with finer elements where such bodies see them"));
    return true;
}

void Solver::tighten_bodies(double limit) {
    constexpr double aim = 0.7;  // share of the limit to aim at; derived from attempt_aim
    for (const BodyError& body : statistics().bodies) {
        if (!body.error || *body.error <= limit) continue;
        BodyShares& shares = body_shares_[bodies().body[body.first]];
        (starts_with_step_ ? shares.gathered : shares.seen) *= aim * limit / *body.error;
    }
}

bool Solver::lower_error() {
    // Factor on the error between intermediate solutions, given by work ~ error^-2.5 to error^-1. Solutions that differ
    // less are not worth an attempt.
    constexpr double step = 0.4;
    const double before = *options_.error;
    while (*options_.error > requested_error_ && has_reached(*options_.error)) {
        const double next = step * std::min(*options_.error, certificate_.largest());
        options_.error = step * next <= requested_error_ ? requested_error_ : next;
    }
    if (*options_.error == before) return false;
    ++shown_;
    if (!has_reached(*options_.error)) return true;
    step_ = Step::certify;
    attempt();
    return false;
}

void Solver::show_light() {
    Solution shown = solution_;
    InterpolantReport report;
    shown.interpolant = shown.direct_in_elements ? shown.indirect : plain_elements(report);
    shown.statistics.energy = energy_balance(shown, direct_, stage_);
    shown.statistics.converged = false;
    show_(std::move(shown));
}

std::optional<Solver::NextAttempt> Solver::next_in_time(double demand, double last_seconds) const {
    // An attempt that cannot finish in time would be discarded. All processes use the first one's clock.
    const double max_work = common_seconds_left(stop_) / as_first(last_seconds);
    for (const double aim : attempt_aims(demand, certificate_.largest())) {
        NextAttempt next = next_attempt(aim);
        if (next.finer.work <= max_work) return next;
    }
    return {};
}

Solver::NextAttempt Solver::next_attempt(double demand) const {
    const double target = calibrated::attempt_aim * demand;
    const double all = certificate_.largest(), rough = certificate_.rough;
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
                                                       .wanted = 0.5 * target,
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

void Solver::keep_noise_of_accurate_rooms(double target, double step) {
    if (step == 1) return;
    noise_in_.resize(stage_.rooms.count(), 1);
    for (std::size_t room = 0; room < noise_in_.size(); ++room) {
        const bool is_accurate =
            certificate_.estimate <= target && statistics().rooms[room].error <= target && step < 1;
        noise_in_[room] = is_accurate ? noise_in_[room] / step : 1;
    }
}

double Solver::not_local(const ErrorParts& parts) const {
    const double all = certificate_.largest(), local = std::hypot(parts.noise, parts.interpolation);
    return std::max(parts.method, std::sqrt(std::max(0.0, all * all - local * local)));
}

const SceneBodies& Solver::bodies() {
    if (!bodies_) bodies_ = find_bodies(stage_.scene);
    return *bodies_;
}

void Solver::project_direct() {
    progress_.phase("direct light");
    // Share of one element that a body sees: derived from four alike, as around the point below the body's middle.
    // Their squared errors, with those of noise and of interpolation, sum to that of the body.
    constexpr double one_of_four = 0.7;
    std::optional<BodyViews> views;
    std::vector<double> tolerance_of;
    if (holds_bodies()) {
        views.emplace(stage_, bodies(), options_.seed);
        body_shares_.resize(bodies().all.size());
        for (const BodyShares& share : body_shares_)
            tolerance_of.push_back(one_of_four * share.seen * knobs_.body_error);
    }
    DirectProjection fresh = project_direct_light(stage_,
                                                  {.mesh = knobs_.solve_mesh,
                                                   .tolerance = knobs_.direct_tolerance,
                                                   .min_area = options_.min_area,
                                                   .may_give_up = direct_.tree.size() > 0,
                                                   .bodies = views ? &*views : nullptr,
                                                   .body_tolerance = tolerance_of},
                                                  stop_);
    if (fresh.tree.size() > 0) {
        const Spectrum scale = keep_emitted_flux(fresh, stage_, options_.seed);
        progress_.note(fmt::format("direct light scaled by {:.5f} to the emitted power", mean(scale)));
        direct_ = std::move(fresh);
        unscaled_.direct = inverse(scale);
        share_on_node(direct_.fit.span());  // this array does not change any more, so processes of a node can share it
    }
}

bool Solver::has_memory() {
    const auto leaves = static_cast<double>(direct_.tree.leaves().size());
    const Result<void> fits = check_method_memory(stage_, options_, knobs_, leaves);
    if (fits) return true;
    refusal_ = fits.error();
    return false;
}

void Solver::project_coarsely() {
    const Knobs fine =
        std::exchange(knobs_, knobs_for_error(calibrated::interrupted_error, stage_.lit_pieces(), options_));
    project_direct();
    knobs_ = fine;
}

void Solver::attempt() {
    if (step_ == Step::project) {
        fresh_ = !light_;
        if (fresh_) project_direct();
        if (fresh_ && !has_memory()) return;
        if (starts_with_step_) take_two_grid_step();
        if (stop_.requested()) return;  // no earlier attempt has light: return direct light only
        reach(Step::solve);
    }
    if (step_ == Step::solve) {
        find_light();
        if (gives_up()) return;
        reach(Step::gather);
    }
    if (step_ == Step::decide) return;
    NextLight found;
    if (next_.parts.empty()) found.parts.push_back(gathered_light(stage_.scene, direct_, *light_, share_));
    for (const ElementFunction& f : found.parts) share_on_node(std::span(f.values));
    const NextLight& gathered_on = next_.parts.empty() ? found : next_;
    steps_.sent = gathers() && keeps_flux() ? arriving_power(stage_.scene, *light_, gathered_on.parts) : Spectrum();
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
        if (corrected_.empty()) corrected_ = corrected_sums();
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
    certify_solution(look, options_.error_demand(), elements);
    reach(Step::decide);
}

void Solver::take_two_grid_step() {
    progress_.phase("solve");
    if (next_.parts.empty()) next_.parts.push_back(gathered_light(stage_.scene, direct_, *light_, share_));
    // The delivered light is scaled such that the flux of the converged solution is conserved. A refinement step would
    // apply that correction twice. Its input is therefore scaled to the arriving power of the light from
    // which it was gathered, so that only the noise of rays is corrected.
    ElementFunction gathered = solution_.indirect;
    if (mean(steps_.sent) > 0) scale(gathered, conserving_scale(steps_.sent, power(gathered)));
    next_ = next_light(stage_, *light_, gathered, direct_, share_, std::move(next_), knobs_.solve_rays, options_.seed);
    for (const auto* const functions : {&next_.parts, &next_.rest})
        for (const ElementFunction& f : *functions) share_on_node(std::span(f.values));
    steps_.not_local = not_local(error_parts());
    starts_with_step_ = false;
    ++statistics().refinement_steps;
}

/// Chooses linear elements if much of the light is in gaps. There, elements receive light from few others, which are
/// near. The gather does not smooth the error of constant elements, and every reflection repeats it.
void Solver::choose_basis() {
    if (!plan_.may_step_on_delivered) return;
    const double in_gaps = share_of_light_in_gaps(stage_, direct_);
    progress_.note(fmt::format("{:.1f}% of the light is in gaps", 100 * in_gaps));
    // The basis is linear if at least 1 / `gap_divisor` of the light is in gaps (under chairs: 1/12; between 60 slats:
    // > 1/4).
    constexpr int gap_divisor = 7;
    if (in_gaps * gap_divisor < 1) return;
    options_.basis = BasisKind::linear;
    statistics().basis = name_in(basis_names, BasisKind::linear);
}

void Solver::find_light() {
    if (fresh_) {
        choose_basis();
        light_ = entry_of(options_.method, form_of(options_))
                     .solve({stage_, options_, knobs_, direct_, progress_, stop_, safe_points(), has_light(), aim_,
                             snapshots_ ? &*snapshots_ : nullptr});
        record_work(*light_, statistics());
        if (!gives_up()) share_ = direct_share();
        light_in_ = light_by_room(stage_, *light_);
        allowed_in_ = allowed_by_room(stage_, light_in_, calibrated::whole_beyond_rooms);
        for (const auto* const values : {&light_->direct, &light_->indirect, &light_->reflected})
            share_on_node(std::span(*values));
        for (const auto* const corners : {&light_->direct_corners, &light_->indirect_corners})
            share_on_node(std::span(*corners));
    }
}

std::vector<ElementGather> Solver::parts_to_sum(std::span<const ElementFunction> functions) const {
    std::vector<ElementGather> out;
    if (gathers() && sums_)
        for (const ElementFunction& f : functions) out.emplace_back(stage_, f);
    return out;
}

std::vector<ElementFunction> Solver::corrected_sums() const {
    return exitance::corrected_sums(stage_, *light_, solution_.indirect, direct_, share_, knobs_.solve_rays,
                                    knobs_.gather_element_share, options_.seed);
}

bool Solver::deliver(std::span<const ElementGather> elements, const ReadNextLight& b, bool fresh) {
    gathered_ = {};
    ElementFunction indirect = gathers() ? gather(b, elements, fresh) : on_leaves(*light_);
    const Spectrum kept =
        gathers() && keeps_flux() ? keep_flux(indirect, stage_.scene, direct_, *light_, share_) : Spectrum(1.0);
    share_on_node(std::span(indirect.values)), share_on_node(indirect.first_value.span());
    share_on_node(gathered_.leaves.span());
    if (stop_.requested()) {
        // Keeps the last complete local pass in place of an interrupted one. Without one, an interrupted pass is still
        // better than the method's solution.
        if (step_ != Step::correct_sums && has_light()) return false;
        if (step_ != Step::correct_sums) {
            if (gathers() && !gathered_.interrupted)
                adopt(std::move(indirect), kept);
            else
                adopt_method_light();
        }
        certify_solution({.error = calibrated::interrupted_error, .seed = certificate_seed()});
        return false;
    }
    adopt(std::move(indirect), kept);
    progress_.note(fmt::format(
        "indirect light scaled by {:.5f} to the arriving power; the method's unscaled light would have {:.5f} of it",
        mean(kept), mean(light_->report.unscaled)));
    return true;
}

void Solver::adopt(ElementFunction indirect, const Spectrum& kept) {
    solution_.indirect = std::move(indirect);
    unscaled_.indirect = unscaled_indirect(kept);
    solution_.own_form = light_->own_form;
    solution_.delivers_own_form = !gathers() && solution_.own_form;
    solution_.direct_share = share_;
    solution_.direct_in_elements = light_->holds_direct();
    record_method(stage_, *light_, has_links_, statistics());
}

void Solver::adopt_method_light() {
    solution_.indirect = constant_on_leaves(*light_);
    unscaled_.indirect = unscaled_.direct * light_->report.unscaled;
    solution_.direct_in_elements = light_->holds_direct();
    record_method(stage_, *light_, has_links_, statistics());
}

Spectrum Solver::unscaled_indirect(const Spectrum& kept) const {
    if (!gathers()) return unscaled_.direct * light_->report.unscaled;
    // The result of a refinement step depends little on the light that it starts from.
    const bool refined = step_ == Step::correct_sums || !next_.parts.empty();
    const Spectrum returned = refined ? Spectrum(1.0) : light_->report.unscaled;
    return unscaled_sent(stage_.scene, *light_, unscaled_.direct, returned, share_) * inverse(kept);
}

bool Solver::keeps_flux() const {
    return options_.bounces < 0 && (!light_->kept.empty() || keeps_reflected_light(stage_, *light_, options_.seed));
}

ElementFunction Solver::on_leaves(const GlobalLight& light) const {
    const std::string& basis = solution_.statistics.basis;
    const bool constant = light.indirect_corners.empty() || basis == name_in(basis_names, BasisKind::haar) ||
                          basis == name_in(basis_names, BasisKind::galerkin1);
    if (!constant) return polynomials_on_leaves(light);
    return options_.smoothing.value_or(false) ? smoothed_on_leaves(light, stage_.scene.regions().size())
                                              : constant_on_leaves(light);
}

Spectrum Solver::direct_share() const {
    if (!gathers() || options_.bounces >= 0) return {};
    const ElementLocator locator(light_->tree, stage_.scene.regions().size());
    return find_direct_share(stage_, *light_, locator, options_.seed);
}

LocalPassDemand Solver::gather_demand(double scale) const {
    return {.rays = knobs_.gather_rays,
            .light = scale,
            .noise = knobs_.gather_noise * scale,
            .tolerance = knobs_.gather_tolerance * scale,
            .curved = knobs_.gather_curved,
            .relative_tolerance = knobs_.gather_relative_tolerance};
}

ElementFunction Solver::gather(const ReadNextLight& b, std::span<const ElementGather> elements, bool fresh) {
    progress_.phase("gather");
    const double scale = light_->mean_reflected(stage_.area);
    std::vector<double> allowed_on_body;
    if (holds_bodies()) {
        allowed_on_body = light_of_bodies(stage_, *light_, bodies(), light_in_);
        for (std::size_t i = 0; i < allowed_on_body.size(); ++i)
            allowed_on_body[i] *= body_shares_[i].gathered * knobs_.body_error;
    }
    if (!local_pass_) local_pass_.emplace(stage_, knobs_.gather_mesh, options_.seed);
    LocalPassDemand demand = gather_demand(scale);
    demand.elements = elements, demand.element_share = knobs_.gather_element_share;
    demand.light_in = allowed_in_, demand.noise_in = noise_in_;
    demand.bodies = holds_bodies() ? &bodies() : nullptr, demand.allowed_on_body = allowed_on_body;
    demand.change = b.change(), demand.rough_places = certificate_.rough_places;
    ElementFunction out = local_pass_->gather(b.whole(), fresh, demand, gathered_, progress_, stop_, safe_points());
    statistics().rays += gathered_.rays;
    return out;
}

}  // namespace exitance
