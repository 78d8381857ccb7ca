#include "exitance/methods/solver/solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "exitance/base/memory.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/calibration/error_budget.hpp"
#include "exitance/evaluate/energy.hpp"
#include "exitance/methods/light/light_functions.hpp"
#include "exitance/methods/light/smoothing.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/methods/run_report.hpp"
#include "exitance/methods/solve_archive.hpp"
#include "exitance/methods/solve_report.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/solution/continuous.hpp"
#include "exitance/solve/conserving_transport.hpp"
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
    plan_ = make_plan(stage_, asked, show ? recognizable_error : hurries ? calibrated::hurried_error : 0);
    for (const std::string& notice : plan_.notices) warn(notice);
    if (!plan_.why.empty())
        progress.note(fmt::format("method {}: {}", name_in(method_names, options_.method), plan_.why));
    record_plan();
    solution_.indirect = dark(stage_);
    share_on_node(solution_.indirect.tree);
}

Result<Solution> Solver::run() {
    if (const Result<void> fits = fit_memory(); !fits) return fits.error();
    resume();
    if (step_ != Step::output) find_light();  // else the run that this one continues has found it
    if (refusal_ && !has_light()) return *refusal_;
    if (refusal_) stop_early(StopReason::memory_limit);
    if (light_ && has_diverged(light_->report)) warn(divergence_warning);
    if (light_ && !light_->kept_links.empty())
        solution_.links = {constant_on_leaves(*light_), std::move(light_->kept_links)};
    // Frees the data that only attempts need before the exported mesh is created.
    light_.reset();
    local_pass_.reset();
    gathered_ = {};
    release_freed_memory();
    make_exported_mesh();
    // for the statistics of escaping light
    if (!has_estimate(options_)) stage_.set_rooms(find_light_rooms(stage_, options_.seed, stop_));
    record_energy();
    progress_.close();
    return std::move(solution_);
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
    a(attempt_, step_, knobs_, direct_, light_, gathered_, certificate_, phase, solution_.indirect, solution_.links,
      solution_.own_form, solution_.delivers_own_form, solution_.direct_share, solution_.direct_in_elements,
      solution_.discontinuity, solution_.statistics);
    rooms_.archive_state(a);
    archive_own(a);
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

void Solver::record_missing_time(double seconds) {
    statistics().figures[next_attempt_seconds] = seconds;
    statistics().figures[seconds_left] = std::max(0.0, common_seconds_left(stop_));
}

void Solver::run_method(double aim, Snapshots* snapshots) {
    lost_.reset();
    light_ =
        entry_of(options_.method, form_of(options_))
            .solve({stage_, options_, knobs_, direct_, progress_, stop_, safe_points(), has_light(), aim, snapshots});
    record_work(*light_, statistics());
    rooms_.set_light(stage_, *light_);
    for (const auto* const values : {&light_->direct, &light_->indirect, &light_->reflected})
        share_on_node(std::span(*values));
    for (const auto* const corners : {&light_->direct_corners, &light_->indirect_corners})
        share_on_node(std::span(*corners));
}

ElementFunction Solver::on_leaves(const GlobalLight& light) const {
    const std::string& basis = solution_.statistics.basis;
    const bool constant = light.indirect_corners.empty() || basis == name_in(basis_names, BasisKind::haar) ||
                          basis == name_in(basis_names, BasisKind::galerkin1);
    if (!constant) return polynomials_on_leaves(light);
    return options_.smoothing.value_or(false) ? smoothed_on_leaves(light, stage_.scene.regions().size())
                                              : constant_on_leaves(light);
}

bool Solver::keeps_flux() const {
    if (options_.bounces >= 0) return false;
    return light_->kept.empty() ? keeps_reflected_light(stage_, *light_, options_.seed)
                                : may_keep_flux(stage_, *light_);
}

const LostLight& Solver::lost_light() {
    if (!lost_) lost_ = find_lost_light(stage_, *light_, options_.seed);
    return *lost_;
}

LocalPassDemand Solver::gather_demand(double scale) const {
    return {.rays = knobs_.gather_rays,
            .light = scale,
            .noise = knobs_.gather_noise * scale,
            .tolerance = knobs_.gather_tolerance * scale,
            .curved = knobs_.gather_curved,
            .relative_tolerance = knobs_.gather_relative_tolerance};
}

const SceneBodies& Solver::bodies() {
    if (!bodies_) bodies_ = find_bodies(stage_.scene);
    return *bodies_;
}

void Solver::record_energy() {
    EnergyBalance& energy = statistics().energy;
    energy = energy_balance(solution_, direct_, stage_);
    if (energy.emitted > 0 && energy.absorbed == 0 && !stop_.requested())
        warn(shines_on_backs(stage_) ? "no light reaches the front of any face: they may be turned inside out"
                                     : "no light reaches any face: all of it leaves the scene");
}

}  // namespace exitance
