#include "exitance/methods/solver/solver.hpp"

#include <fmt/format.h>

#include <utility>

#include "exitance/base/memory.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/methods/plan/memory_plan.hpp"
#include "exitance/methods/solve_archive.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/solve/growth_watch.hpp"

namespace exitance {

Solver::Solver(Scene scene, const SolveOptions& asked, Progress& progress, const StopRequest& stop,
               CheckpointStore* checkpoints, const ShowLight& show)
    : stop_(stop),
      checkpoints_(checkpoints),
      show_(show),
      solution_{.scene = std::move(scene)},
      progress_(progress, solution_.statistics.seconds),
      stage_(solution_.scene) {
    release_freed_memory();
    share_on_node(solution_.scene.surfaces().span());
    share_on_node(stage_.occluders), share_on_node(stage_.contacts), share_on_node(std::span(stage_.pieces));
    survey(stage_, asked, stop);
    release_freed_memory();
    // Before a near deadline, a coarse solution is computed first, so that there is a result when time runs out. With
    // checkpoints, another run may continue; its result must not depend on the time limit of this run.
    const bool hurries = common_seconds_left(stop) < calibrated::near_deadline && !checkpoints_;
    // Error of the first solution that a viewer shows. Given by judgement, not measured: a scene is recognizable in it.
    constexpr double first_shown_error = 0.32;
    plan_ = make_plan(stage_, asked, show ? first_shown_error : hurries ? calibrated::hurried_error : 0);
    requested_error_ = options_.error_target();
    if (show && options_.error_demand() && !is_published())
        options_.error = std::max(first_shown_error, requested_error_);
    for (const std::string& notice : plan_.notices) warn(notice);
    if (!plan_.why.empty())
        progress.note(fmt::format("method {}: {}", name_in(method_names, options_.method), plan_.why));
    record_plan();
    solution_.indirect = dark(stage_);
    share_on_node(solution_.indirect.tree);
}

Result<Solution> Solver::run() {
    const bool reflects = options_.bounces != 0 && stage_.has_indirect_light();
    if (const Result<void> fits = fit_memory(); !fits) return fits.error();
    resume();
    if (step_ == Step::output) {
        // The light has been found by the run that this one continues.
    } else if (is_published()) {
        solve_published();
        warn_of_bodies();
    } else if (reflects) {
        solve_indirect_light();
        warn_of_bodies();
    } else {
        solve_direct_light();
    }
    if (refusal_ && !has_light()) return *refusal_;
    if (refusal_) stop_early(StopReason::memory_limit);
    if (light_ && has_diverged(light_->report)) warn(divergence_warning);
    if (light_ && !light_->kept_links.empty())
        solution_.links = {constant_on_leaves(*light_), std::move(light_->kept_links)};
    // Frees the data that only attempts need before the output mesh is created.
    light_.reset();
    local_pass_.reset();
    gathered_ = {};
    release_freed_memory();
    make_output_mesh();
    progress_.close();
    return std::move(solution_);
}

Result<void> Solver::fit_memory() {
    if (!options_.memory_limit_bytes || is_published()) return {};  // published forms stop refining at the limit
    const Result<bool> fits = fit_into_memory(knobs_, stage_, options_);
    if (!fits) return fits.error();
    if (!*fits) stop_early(StopReason::memory_limit);
    return {};
}

void Solver::solve_direct_light() {
    if (!makes_discontinuity_mesh() || solution_.scene.has_light_from_outside()) project_direct();
    statistics().elements = direct_.tree.size();
    statistics().leaf_elements = direct_.tree.leaves().size();
    record_zero_error();
    record_noise_of_direct_light_alone();
}

void Solver::record_plan() {
    const MethodEntry& method = entry_of(options_.method, form_of(options_));
    solution_.bounces = options_.bounces;
    statistics().method = name_in(method_names, method.id);
    const bool chosen =
        options_.basis && (method.id == Method::wavelet || (method.id == Method::matrix && options_.bounces < 0));
    statistics().basis = chosen ? name_in(basis_names, *options_.basis) : method.basis;
    statistics().threads = threads();
    statistics().schedule = name_in(schedule_names, schedule());
    statistics().surfaces = solution_.scene.surfaces().size();
    statistics().converged = true;
}

template <class Archive>
void Solver::archive_state(Archive& a, std::string& phase) {
    a(attempt_, step_, fresh_, share_, knobs_, direct_, unscaled_, light_, corrected_, gathered_, certificate_, phase,
      steps_, aim_);
    next_.archive_state(a);
    a(body_attempts_, worst_body_before_, body_shares_, light_in_, allowed_in_, noise_in_, solution_.indirect,
      solution_.links, solution_.own_form, solution_.delivers_own_form, solution_.direct_share,
      solution_.direct_in_elements, solution_.discontinuity, solution_.statistics);
    bool has_local_pass = local_pass_.has_value();
    a(has_local_pass);
    if (has_local_pass && !local_pass_) local_pass_.emplace(stage_, knobs_.gather_mesh, options_.seed);
    if (has_local_pass) local_pass_->archive_state(a);
}

void Solver::resume() {
    const std::string state = checkpoints_ ? checkpoints_->resumed() : std::string();
    if (state.empty()) return;
    const SolveStatistics own = solution_.statistics;
    ArchiveReader reader(state);
    archive_state(reader, resumed_phase_);
    EXI_CHECK(reader.good() && reader.left() == 0);  // the store has verified the checksum
    statistics().threads = own.threads, statistics().schedule = own.schedule;
}

void Solver::keep(std::string phase) {
    // All processes have the same state except for their own statistics; those of the first process are saved.
    ArchiveWriter told;
    told(statistics());
    const std::string of_first = as_first(told.take(), "checkpoint");
    ArchiveReader reader(of_first);
    reader(statistics());
    ArchiveWriter writer({own_process(), processes()});
    archive_state(writer, phase);
    EXI_CHECK(as_first(writer.size()) == writer.size());
    checkpoints_->keep(writer.take());
}

void Solver::reach(Step step) {
    step_ = step;
    if (checkpoints_ && !stop_.requested() && checkpoints_->is_due()) keep({});
}

SafePoints Solver::safe_points() {
    return {checkpoints_, stop_, [this](std::string phase) { keep(std::move(phase)); },
            std::exchange(resumed_phase_, {})};
}

void Solver::warn(std::string message) {
    progress_.warn(message);
    statistics().warnings.push_back(std::move(message));
}

void Solver::record_zero_error() {
    statistics().relative_error_estimate = statistics().relative_error_bound = 0;
    statistics().relative_error_estimate_worst_room = 0;
    statistics().relative_error_estimate_worst_body = 0;
    statistics().error_p99 = 0;
    statistics().rooms = {{stage_.area, 0, 0}};
}

void Solver::stop_early(StopReason why) {
    statistics().stopped_by = why;
    statistics().converged = false;
}

}  // namespace exitance
