#include "exitance/methods/solver/standard_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "exitance/calibration/error_budget.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/methods/plan/method_memory.hpp"
#include "exitance/methods/solve_report.hpp"
#include "exitance/solution/continuous.hpp"
#include "exitance/solve/conserving_transport.hpp"
#include "exitance/solve/direct_share.hpp"
#include "exitance/transport/body_views.hpp"
#include "exitance/transport/narrow_places.hpp"

namespace exitance {

void StandardSolver::project_direct() {
    progress_.phase("direct light");
    std::optional<BodyViews> views;
    std::vector<double> tolerance_of;
    if (holds_bodies()) {
        views.emplace(stage_, bodies(), options_.seed);
        body_demand_.resize(bodies().all.size());
        tolerance_of = body_demand_.allowed_on_seen_elements(knobs_.body_error);
    }
    DirectProjection fresh = project_direct_light(stage_,
                                                  {.mesh = knobs_.solve_mesh,
                                                   .tolerance = knobs_.direct_tolerance,
                                                   .min_area = options_.min_area,
                                                   .may_give_up = direct_.tree.size() > 0 || light_is_dropped_at_stop(),
                                                   .bodies = views ? &*views : nullptr,
                                                   .body_tolerance = tolerance_of,
                                                   .progress = &progress_},
                                                  stop_);
    if (fresh.tree.size() > 0) {
        const Spectrum scale = keep_emitted_flux(fresh, stage_, options_.seed);
        progress_.note(fmt::format("direct light scaled by {:.5f} to the emitted power", mean(scale)));
        direct_ = std::move(fresh);
        unscaled_.direct = inverse(scale);
        share_on_node(direct_.fit.span());  // this array does not change any more, so processes of a node can share it
    }
}

bool StandardSolver::light_is_dropped_at_stop() const {
    return !has_light() && !show_ && has_estimate(options_) && options_.bounces != 0 && stage_.has_indirect_light();
}

void StandardSolver::project_coarsely() {
    const Knobs fine =
        std::exchange(knobs_, knobs_for_error(calibrated::interrupted_error, stage_.lit_spaces(), options_));
    project_direct();
    knobs_ = fine;
}

bool StandardSolver::has_memory() {
    const auto leaves = static_cast<double>(direct_.tree.leaves().size());
    const Result<void> fits = check_method_memory(stage_, options_, knobs_, leaves);
    if (fits) return true;
    refusal_ = fits.error();
    return false;
}

/// Chooses linear elements if much of the light is in gaps. There, elements receive light from few others, which are
/// near. The gather does not smooth the error of constant elements, and every reflection repeats it.
void StandardSolver::choose_basis() {
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

void StandardSolver::find_method_light() {
    if (!fresh_) return;
    choose_basis();
    run_method(default_error, nullptr);
    if (!gives_up()) share_ = direct_share();
}

void StandardSolver::take_two_grid_step() {
    progress_.phase("solve");
    if (next_.parts.empty()) next_.parts.push_back(gathered_light(stage_.scene, direct_, *light_, share_));
    // The delivered light is scaled such that the flux of the converged solution is conserved. A refinement step would
    // apply that correction twice. Its input is therefore scaled to the arriving power of the light from
    // which it was gathered, so that only the noise of rays is corrected.
    ElementFunction gathered = solution_.indirect;
    if (mean(steps_.sent) > 0) scale(gathered, conserving_scale(steps_.sent, power(gathered)));
    next_ = next_light(refinement_of(gathered), std::move(next_));
    for (const auto* const functions : {&next_.parts, &next_.rest})
        for (const ElementFunction& f : *functions) share_on_node(std::span(f.values));
    steps_.not_local = not_local(error_parts());
    starts_with_step_ = false;
    ++statistics().refinement_steps;
}

std::vector<ElementGather> StandardSolver::parts_to_sum(std::span<const ElementFunction> functions) const {
    std::vector<ElementGather> out;
    if (gathers() && sums_)
        for (const ElementFunction& f : functions) out.emplace_back(stage_, f);
    return out;
}

RefinementInput StandardSolver::refinement_of(const ElementFunction& indirect) const {
    return {stage_, *light_, indirect, direct_, share_, knobs_.solve_rays, options_.seed};
}

Spectrum StandardSolver::direct_share() const {
    if (!gathers() || options_.bounces >= 0) return {};
    const ElementLocator locator(light_->tree, stage_.scene.regions().size());
    return find_direct_share(stage_, *light_, locator, options_.seed);
}

bool StandardSolver::deliver(std::span<const ElementGather> elements, const ReadNextLight& b, bool fresh) {
    gathered_ = {};
    ElementFunction indirect = gathers() ? gather(b, elements, fresh) : on_leaves(*light_);
    const Spectrum kept =
        gathers() && keeps_flux() ? keep_flux(indirect, stage_.scene, direct_, lost_light(), share_) : Spectrum(1.0);
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
        certify({.error = calibrated::interrupted_error, .seed = certificate_seed()});
        return false;
    }
    adopt(std::move(indirect), kept);
    progress_.note(fmt::format(
        "indirect light scaled by {:.5f} to the arriving power; the method's unscaled light would have {:.5f} of it",
        mean(kept), mean(light_->report.unscaled)));
    return true;
}

ElementFunction StandardSolver::gather(const ReadNextLight& b, std::span<const ElementGather> elements, bool fresh) {
    progress_.phase("gather");
    const double scale = light_->mean_reflected(stage_.area);
    std::vector<double> allowed_on_body;
    if (holds_bodies()) {
        allowed_on_body = light_of_bodies(stage_, *light_, bodies(), rooms_.light_in());
        body_demand_.allow_on_gathered(allowed_on_body, knobs_.body_error);
    }
    if (!local_pass_) local_pass_.emplace(stage_, knobs_.gather_mesh, options_.seed);
    LocalPassDemand demand = gather_demand(scale);
    demand.elements = elements, demand.element_share = knobs_.gather_element_share;
    demand.light_in = rooms_.allowed_in(), demand.noise_in = rooms_.noise_in();
    demand.bodies = holds_bodies() ? &bodies() : nullptr, demand.allowed_on_body = allowed_on_body;
    demand.change = b.change(), demand.rough_places = certificate_.rough_places;
    ElementFunction out = local_pass_->gather(b.whole(), fresh, demand, gathered_, progress_, stop_, safe_points());
    statistics().rays += gathered_.rays;
    return out;
}

void StandardSolver::adopt(ElementFunction indirect, const Spectrum& kept) {
    solution_.indirect = std::move(indirect);
    unscaled_.indirect = unscaled_indirect(kept);
    solution_.own_form = light_->own_form;
    solution_.delivers_own_form = !gathers() && solution_.own_form;
    solution_.direct_share = share_;
    solution_.direct_in_elements = light_->holds_direct();
    record_method(stage_, *light_, has_links_, statistics());
}

void StandardSolver::adopt_method_light() {
    solution_.indirect = constant_on_leaves(*light_);
    unscaled_.indirect = unscaled_.direct * light_->report.unscaled;
    solution_.direct_in_elements = light_->holds_direct();
    record_method(stage_, *light_, has_links_, statistics());
}

Spectrum StandardSolver::unscaled_indirect(const Spectrum& kept) const {
    if (!gathers()) return unscaled_.direct * light_->report.unscaled;
    // The result of a refinement step depends little on the light that it starts from.
    const bool refined = step_ == Step::correct_sums || !next_.parts.empty();
    const Spectrum returned = refined ? Spectrum(1.0) : light_->report.unscaled;
    return unscaled_sent(stage_.scene, *light_, unscaled_.direct, returned, share_) * inverse(kept);
}

}  // namespace exitance
