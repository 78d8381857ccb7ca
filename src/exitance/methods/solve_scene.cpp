#include "exitance/methods/solve_scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "exitance/calibration/numbers.hpp"
#include "exitance/core/memory.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/core/phase_times.hpp"
#include "exitance/methods/diffusing_panes.hpp"
#include "exitance/methods/importance.hpp"
#include "exitance/methods/light/discontinuity_light.hpp"
#include "exitance/methods/light/light_functions.hpp"
#include "exitance/methods/light/refined_light.hpp"
#include "exitance/methods/light/smoothing.hpp"
#include "exitance/methods/lines/solve_by_lines.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/methods/plan/memory_plan.hpp"
#include "exitance/methods/plan/plan.hpp"
#include "exitance/methods/solve_archive.hpp"
#include "exitance/methods/solve_report.hpp"
#include "exitance/methods/tasks/solve_by_tasks.hpp"
#include "exitance/reconstruct/continuous.hpp"
#include "exitance/reconstruct/energy.hpp"
#include "exitance/reconstruct/error/certificate.hpp"
#include "exitance/reconstruct/error/clustering_error.hpp"
#include "exitance/reconstruct/interpolant.hpp"
#include "exitance/reconstruct/local_pass.hpp"
#include "exitance/reconstruct/quick_function.hpp"
#include "exitance/solve/direct_share.hpp"
#include "exitance/transport/distributed.hpp"

namespace exitance {
namespace {

const MethodEntry& entry_of(Method id) {
    const auto table = method_table();
    return *std::find_if(table.begin(), table.end(), [&](const MethodEntry& m) { return m.id == id; });
}

class Solver {
  public:
    Solver(Scene scene, const SolveOptions& asked, Progress& progress, const StopRequest& stop,
           CheckpointStore* checkpoints)
        : progress_(progress),
          stop_(stop),
          checkpoints_(checkpoints),
          solution_{.scene = std::move(scene)},
          stage_(solution_.scene) {
        release_freed_memory();
        share_on_node(solution_.scene.surfaces().span());
        share_on_node(stage_.occluders), share_on_node(stage_.contacts), share_on_node(std::span(stage_.pieces));
        survey(stage_, asked, stop);
        release_freed_memory();
        // Under a near deadline a coarse answer comes first, so that there is one whenever time runs out. Not where
        // another run may go on: its light is not to depend on how long this one had.
        plan_ = make_plan(stage_, asked, seconds_left(stop) < calibrated::near_deadline && !checkpoints_);
        for (const std::string& notice : plan_.notices) warn(notice);
        if (!plan_.why.empty())
            progress.note(fmt::format("method {}: {}", name_in(method_names, options_.method), plan_.why));
        record_plan();
        solution_.indirect = dark(stage_);
        share_on_node(solution_.indirect.tree);
    }

    Result<Solution> run() {
        if (options_.memory_limit_bytes) {
            const Result<bool> fits = fit_into_memory(knobs_, stage_.pieces, options_);
            if (!fits) return fits.error();
            if (!*fits) stop_early("memory limit");
        }
        if (options_.bounces != 0 && stage_.has_indirect_light()) {
            resume();
            if (step_ != Step::output) solve_indirect_light();
        } else if (resume(); step_ != Step::output) {
            if (!makes_discontinuity_mesh() || solution_.scene.has_light_from_outside()) project_direct();
            statistics().elements = direct_.tree.size();
            statistics().leaf_elements = direct_.tree.leaves().size();
            tell_exact();
            tell_clustering_error();
        }
        if (light_ && !light_->kept_links.empty())
            solution_.links = {constant_on_leaves(*light_), std::move(light_->kept_links)};
        // What only attempts need makes room for the mesh that is written.
        light_.reset();
        local_pass_.reset();
        gathered_ = {};
        release_freed_memory();
        make_output_mesh();
        return std::move(solution_);
    }

  private:
    /// The estimate by so many points is itself uncertain, by a fifth where they are as few as at first: it has to be
    /// below this share of the demand.
    static double margin(std::size_t points) {
        const double first = static_cast<double>(CertificateOptions().points);
        return 1 - calibrated::estimate_margin * (points > 0 ? std::sqrt(first / static_cast<double>(points)) : 1);
    }

    /// What comes next within an attempt.
    enum class Step : std::uint8_t { project, solve, gather, refine, certify, decide, output };

    SolveStatistics& statistics() { return solution_.statistics; }

    void record_plan() {
        const MethodEntry& method = entry_of(options_.method);
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

    /// All that the steps to come depend on; `phase` is the state within a step, or empty.
    template <class Archive>
    void archive_state(Archive& a, std::string& phase) {
        a(attempt_, step_, fresh_, share_, knobs_, direct_, light_, refined_, gathered_, certificate_, phase,
          becomes_linear_);
        a(light_in_, solution_.indirect, solution_.links, solution_.cells, solution_.direct_share,
          solution_.direct_in_elements, solution_.statistics);
        bool has_local_pass = local_pass_.has_value();
        a(has_local_pass);
        if (has_local_pass && !local_pass_) local_pass_.emplace(stage_, knobs_.gather_mesh, options_.seed);
        if (has_local_pass) local_pass_->archive_state(a);
    }

    void resume() {
        const std::string state = checkpoints_ ? checkpoints_->resumed() : std::string();
        if (state.empty()) return;
        const SolveStatistics own = solution_.statistics;
        ArchiveReader reader(state);
        archive_state(reader, resumed_phase_);
        EXI_CHECK(reader.good() && reader.left() == 0);  // the store has checked every byte
        statistics().threads = own.threads, statistics().schedule = own.schedule;
        if (becomes_linear_) options_.basis = BasisKind::linear;
    }

    void keep(std::string phase) {
        ArchiveWriter writer;
        archive_state(writer, phase);
        checkpoints_->keep(writer.take());
    }

    /// Everything before this step is done.
    void reach(Step step) {
        step_ = step;
        if (checkpoints_ && !stop_.requested() && checkpoints_->is_due()) keep({});
    }

    /// For the step that is running.
    SafePoints safe_points() {
        return {checkpoints_, stop_, [this](std::string phase) { keep(std::move(phase)); },
                std::exchange(resumed_phase_, {})};
    }

    void warn(std::string message) {
        progress_.warn(message);
        statistics().warnings.push_back(std::move(message));
    }

    /// Nothing reflects any light, and direct light is exact.
    void tell_exact() {
        statistics().relative_error_estimate = statistics().relative_error_bound = 0;
        statistics().relative_error_estimate_worst_room = 0;
        statistics().error_p99 = 0;
        statistics().rooms = {{stage_.area, 0, 0}};
    }

    void stop_early(const char* why) {
        statistics().stopped_by = why;
        statistics().converged = false;
    }

    /// Method, local pass, certificate, until the certificate is content.
    void solve_indirect_light() {
        constexpr int most_attempts = 9;
        const std::optional<double> demand = options_.error_demand();
        for (;; ++attempt_, step_ = Step::project) {
            const Stopwatch watch;
            attempt();
            if (stop_.requested()) return stop_early(stop_.interrupted() ? "interrupt" : "time limit");
            if (!demand || certificate_.largest() <= margin(certificate_.points) * *demand) {
                if (statistics().stopped_by.empty() || demand)
                    statistics().converged = true, statistics().stopped_by.clear();
                return;
            }
            if (light_->limited_by_memory) stop_early("memory limit");
            if (statistics().stopped_by == "memory limit") return;
            if (attempt_ == most_attempts) return stop_early("iterations");
            const Tightened finer = tightened(knobs_, error_parts(), calibrated::attempt_aim * *demand, options_);
            // One that cannot end in time would only be thrown away.
            if (as_first(seconds_left(stop_) < watch.seconds() * finer.work)) return stop_early("time limit");
            progress_.note(fmt::format("error {:.2f}%, {:.2f}% asked for: once more, finer{}",
                                       100 * certificate_.largest(), 100 * *demand,
                                       finer.method ? "" : ", on the light that the method found"));
            const Knobs before = std::exchange(knobs_, finer.knobs);
            if (finer.method) light_.reset();
            if (finer.method && may_become_linear()) become_linear(before);
            if (options_.memory_limit_bytes) {
                const Result<bool> fits = fit_into_memory(knobs_, stage_.pieces, options_);
                if (!fits || !*fits) return stop_early("memory limit");
            }
        }
    }

    /// Finer constants need a number of elements and rays that grows with the square of the precision; linear functions
    /// on the elements there are have a third of their error for three times the rays. So constants are for one
    /// attempt.
    bool may_become_linear() const { return plan_.may_become_linear && !becomes_linear_; }
    void become_linear(const Knobs& before) {
        becomes_linear_ = true;
        knobs_.solve_mesh = before.solve_mesh, knobs_.direct_tolerance = before.direct_tolerance;
        knobs_.solve_rays = before.solve_rays;
    }

    void project_direct() {
        progress_.phase("direct light");
        const Stopwatch watch;
        DirectProjection fresh = project_direct_light(stage_,
                                                      {.mesh = knobs_.solve_mesh,
                                                       .tolerance = knobs_.direct_tolerance,
                                                       .least_area = options_.min_area,
                                                       .may_give_up = direct_.tree.size() > 0,
                                                       .seed = options_.seed},
                                                      stop_);
        if (fresh.tree.size() > 0) {
            const Spectrum scale = keep_emitted_flux(fresh, stage_, options_.seed);
            progress_.note(fmt::format("direct light scaled by {:.5f} to what is emitted", mean(scale)));
            direct_ = std::move(fresh);
        }
        statistics().seconds["mesh"] += watch.seconds();
    }

    /// Plain elements for when no time is left for a mesh that follows shadows.
    void project_coarsely() {
        const Knobs fine =
            std::exchange(knobs_, knobs_for_error(calibrated::coarse_light_error, stage_.lit_pieces(), options_));
        project_direct();
        knobs_ = fine;
    }

    /// One attempt: what the last one found is kept as far as it is good enough.
    void attempt() {
        if (step_ == Step::project) {
            fresh_ = !light_;
            const bool stays = fresh_ && becomes_linear_ && !options_.basis;  // the mesh, and direct light on it
            if (becomes_linear_) options_.basis = BasisKind::linear, statistics().basis = "linear";
            if (fresh_ && !stays) project_direct();
            if (stop_.requested()) return;  // where there is no light of another attempt, direct light is all there is
            reach(Step::solve);
        }
        if (step_ == Step::solve) {
            find_light();
            if (gives_up()) return;
            reach(Step::gather);
        }
        if (step_ == Step::decide) return;
        Stopwatch watch;
        const ElementFunction light = gathered_light(stage_.scene, direct_, *light_, share_);
        const QuickFunction b(light, stage_.scene.regions().size());
        release_freed_memory();
        if (step_ == Step::gather) {
            refined_.clear();
            const bool whole = deliver(parts_to_sum({&light, 1}), b, fresh_);
            statistics().seconds["reconstruct"] += watch.restart();
            if (!whole) return;
            reach(Step::refine);
        }
        if (step_ == Step::refine && refines()) {
            if (refined_.empty()) refined_ = refine();
            const bool whole = deliver(parts_to_sum(refined_), b, true);
            statistics().seconds["reconstruct"] += watch.restart();
            if (!whole) return;
        }
        reach(Step::certify);
        const std::vector<ElementGather> elements = refines() ? parts_to_sum(refined_) : parts_to_sum({&light, 1});
        progress_.phase("certify");
        CertificateOptions look{
            .error = options_.error_target(),
            .points = CertificateOptions::points_for(elements_of_continuous(solution_.indirect.tree))};
        if (sums_) look.points /= 2;  // without noise
        if (gathers()) look.leaves = &gathered_.leaves, look.gathered = &b;
        certify_solution(look, options_.error_demand(), elements);
        statistics().seconds["certify"] += watch.restart();
        reach(Step::decide);
    }

    /// Of an attempt, with its estimate.
    bool has_light() const { return certificate_.points > 0; }

    /// Once a stop is asked for, what another attempt has found stands.
    bool gives_up() const { return stop_.requested() && has_light(); }

    void find_light() {
        const Stopwatch watch;
        if (fresh_) {
            light_ = entry_of(options_.method)
                         .solve({stage_, options_, knobs_, direct_, progress_, stop_, safe_points(), has_light()});
            record_work(*light_, statistics());
            if (!gives_up()) share_ = direct_share();
            light_in_ = light_by_room(stage_, *light_);
        }
        statistics().seconds["solve"] += watch.seconds();
    }

    /// Functions as elements to be summed over; none where light is found by rays.
    std::vector<ElementGather> parts_to_sum(std::span<const ElementFunction> functions) const {
        std::vector<ElementGather> out;
        if (gathers() && sums_)
            for (const ElementFunction& f : functions) out.emplace_back(stage_, f);
        return out;
    }

    bool refines() const { return gathers() && sums_ && knobs_.refined; }

    /// One step on from what is delivered.
    std::vector<ElementFunction> refine() const {
        return refined_light(stage_, *light_, solution_.indirect, direct_, share_, knobs_.solve_rays,
                             knobs_.gather_element_share, options_.seed);
    }

    /// Light everywhere, from what the method found: `b`, as elements where those are summed. `fresh`: it is not what
    /// was gathered last. False when a request to stop cut that short.
    bool deliver(std::span<const ElementGather> elements, const QuickFunction& b, bool fresh) {
        gathered_ = {};
        ElementFunction indirect = gathers() ? gather(b, elements, fresh) : on_leaves();
        if (gathers() && keeps_flux()) keep_flux(indirect, stage_.scene, direct_, *light_, share_);
        if (stop_.requested()) {
            // Half a local pass is worth less than the last whole one, or than what the method has found.
            if (step_ != Step::refine) {
                if (has_light()) return false;
                solution_.indirect = constant_on_leaves(*light_);
                solution_.direct_in_elements = light_->holds_direct;
                record_method(stage_, *light_, has_links_, statistics());
            }
            certify_solution({.error = calibrated::interrupted_error});
            return false;
        }
        solution_.indirect = std::move(indirect);
        solution_.cells = light_->cells;
        solution_.cells.delivered = !gathers() && !solution_.cells.cells.empty();
        solution_.direct_share = share_;
        solution_.direct_in_elements = light_->holds_direct;
        record_method(stage_, *light_, has_links_, statistics());
        return true;
    }

    /// Is the method's light gathered once more, or are its elements what is delivered?
    bool gathers() const { return !light_->holds_direct && !light_->delivers && !options_.smoothing; }

    /// Is it known how much light is to arrive? As the method tells, or because the scene is closed.
    bool keeps_flux() const {
        return options_.bounces < 0 && (!light_->kept.empty() || keeps_reflected_light(stage_, *light_, options_.seed));
    }

    ElementFunction on_leaves() const {
        const std::string& basis = solution_.statistics.basis;
        const bool constant = light_->indirect_corners.empty() || basis == name_in(basis_names, BasisKind::haar) ||
                              basis == name_in(basis_names, BasisKind::galerkin1);
        if (!constant) return polynomials_on_leaves(*light_);
        return options_.smoothing.value_or(false) ? smoothed_on_leaves(*light_, stage_.scene.regions().size())
                                                  : constant_on_leaves(*light_);
    }

    Spectrum direct_share() const {
        if (!gathers() || options_.bounces >= 0) return {};
        const ElementLocator locator(light_->tree, stage_.scene.regions().size());
        return find_direct_share(stage_, *light_, locator, options_.seed);
    }

    ElementFunction gather(const ReflectedLight& b, std::span<const ElementGather> elements, bool fresh) {
        progress_.phase("gather");
        const double scale = light_->mean_reflected(stage_.area);
        if (!local_pass_) local_pass_.emplace(stage_, knobs_.gather_mesh, options_.seed);
        ElementFunction out = local_pass_->gather(b, fresh,
                                                  {.rays = knobs_.gather_rays,
                                                   .noise = knobs_.gather_noise * scale,
                                                   .tolerance = knobs_.gather_tolerance * scale,
                                                   .curved = knobs_.gather_curved,
                                                   .relative_tolerance = knobs_.gather_relative_tolerance,
                                                   .elements = elements,
                                                   .element_share = knobs_.gather_element_share,
                                                   .light_in = light_in_},
                                                  gathered_, progress_, stop_, safe_points());
        statistics().rays += gathered_.rays;
        return out;
    }

    void certify_solution(CertificateOptions options, std::optional<double> demand = {},
                          std::span<const ElementGather> gathered = {}) {
        options.seed = options_.seed;
        options.direct_in_elements = light_->holds_direct;
        options.light_in = light_in_;
        if (has_links_) options.places = places_of(stage_, solution_.indirect.tree, options_.importance);
        // Where reflections are counted, the light to be gathered is one reflection older than what is delivered.
        std::optional<ElementFunction> older;
        if (options_.bounces > 0) older = constant_on_leaves(*light_);
        const ElementFunction& indirect = older ? *older : solution_.indirect;
        const Spectrum c = solution_.direct_share;
        const Spectrum direct_weight = light_->holds_direct ? Spectrum() : Spectrum(1.0) - c;
        const DeliveredLight delivered(stage_.scene, indirect, direct_, direct_weight, c);
        SummedLight summed{.delivered = {}, .gathered = gathered, .share = calibrated::certified_share * options.error};
        if (sums_) {
            for (const ElementFunction& part : delivered_functions(stage_.scene, indirect, direct_, direct_weight, c))
                summed.delivered.emplace_back(stage_, part);
            options.summed = &summed;
        }
        Certifier certifier(stage_, *light_, solution_.indirect, delivered, options);
        certificate_ = certifier.look();
        // Few points tell an estimate to a tenth or so, or to a third where a few of them hold most of it. One that is
        // not surely too large is looked at again, which is cheaper than another attempt for nothing.
        constexpr std::size_t most_looks = 4;
        for (std::size_t looks = 1; demand && looks < most_looks && !stop_.requested(); ++looks) {
            const double limit = margin(certificate_.points) * *demand;
            const double estimate = certificate_.largest();
            if (estimate <= limit || estimate - 2 * certificate_.uncertainty > limit) break;
            certificate_ = certifier.look();
        }
        add_clustering_error();
        record_certificate(certificate_, *light_, solution_.indirect, statistics());
        statistics().rooms = certifier.rooms();
        if (certificate_.points == 0 && !stop_.requested()) tell_exact();
        progress_.note(describe(certificate_, *light_, solution_.indirect, gathered_));
    }

    /// Direct light at points is exact, or within this where emitters are many.
    void add_clustering_error() {
        if (certificate_.points == 0 || light_->holds_direct) return;
        const double more =
            clustering_error(stage_, direct_, point_accuracy(certificate_.estimate)) / certificate_.mean_reflected;
        if (!(more > 0)) return;
        certificate_.estimate = std::hypot(certificate_.estimate, more);
        certificate_.bound = std::hypot(certificate_.bound, more);
        certificate_.worst_room = std::hypot(certificate_.worst_room, more);
    }

    /// Where direct light is all there is.
    void tell_clustering_error() {
        const double error = clustering_error(stage_, direct_, point_accuracy(1));
        if (error > 0)
            statistics().relative_error_estimate = statistics().relative_error_bound =
                error / mean_direct_light(stage_, direct_);
    }

    /// What the estimate is made of, relative to the mean reflected light.
    ErrorParts error_parts() const {
        if (!gathers()) return {.method = certificate_.largest()};
        // Of the worst room, as if its parts were made like those of all.
        const bool has_rooms = stage_.rooms.count() > 0 && certificate_.of_rooms > 0;
        const double worse = has_rooms ? certificate_.worst_room / certificate_.of_rooms : 1;
        const ErrorParts parts = mean_error_parts();
        return {worse * parts.method, worse * parts.noise, worse * parts.interpolation};
    }

    ErrorParts mean_error_parts() const {
        const double noise = gathered_.noise / certificate_.mean_reflected;
        const double misfit = std::sqrt(std::max(0.0, certificate_.local * certificate_.local - noise * noise));
        return {.method = certificate_.method,
                .noise = noise,
                .interpolation = std::max(misfit, gathered_.interpolation / certificate_.mean_reflected)};
    }

    bool makes_discontinuity_mesh() const {
        return options_.method == Method::discontinuity && !solution_.direct_in_elements;
    }

    /// Direct light on triangles that follow its shadows, with what is reflected on top of it. False where a request to
    /// stop left no time for any: then plain elements are made.
    bool make_discontinuity() {
        progress_.phase("discontinuities");
        reach(Step::output);
        // Under a limit, coarse elements come first, so that there is light whenever time runs out.
        const bool has_none = direct_.tree.size() == 0;
        if (has_none && std::isfinite(stop_.seconds_left())) {
            project_coarsely();
            progress_.phase("discontinuities");
        }
        SafePoints points = safe_points();
        const DiscontinuityReport report =
            add_discontinuity_mesh(stage_, options_, solution_, stop_, checkpoints_ ? &points : nullptr);
        statistics().seconds["mesh"] += report.mesh_seconds, statistics().seconds["direct"] += report.direct_seconds;
        mesh_seconds_ = report.mesh_seconds + report.direct_seconds;
        if (report.interrupted) stop_early(stop_.interrupted() ? "interrupt" : "time limit");
        const bool follows_shadows = !solution_.discontinuity.empty();
        // What is told of the mesh is not to depend on whether there was a limit.
        if (follows_shadows && options_.bounces == 0 && !solution_.scene.has_light_from_outside()) direct_ = {};
        if (!follows_shadows && direct_.tree.size() == 0) project_coarsely();
        return follows_shadows;
    }

    void make_output_mesh() {
        const Stopwatch watch;
        progress_.phase("reconstruct");
        const bool follows_shadows = makes_discontinuity_mesh() && make_discontinuity();
        if (follows_shadows) {
            // The mesh is what is exported.
        } else if (solution_.direct_in_elements) {
            solution_.interpolant = solution_.indirect;
            statistics().relative_error_estimate_interpolant = statistics().relative_error_estimate;
        } else {
            // Where nothing reflects, E itself is what errors are relative to.
            const double scale =
                certificate_.mean_reflected > 0 ? certificate_.mean_reflected : mean_direct_light(stage_, direct_);
            InterpolantReport report;
            solution_.interpolant = make_interpolant(
                stage_, direct_, solution_.indirect, solution_.direct_share,
                {.tolerance =
                     options_.error_interpolant.value_or(calibrated::interpolant_error * options_.error_target()) *
                     scale,
                 .light_in = light_in_},
                report, stop_);
            const double own = scale > 0 ? report.error / scale : 0;
            if (statistics().relative_error_estimate && !report.interrupted)
                statistics().relative_error_estimate_interpolant =
                    std::hypot(own, *statistics().relative_error_estimate);
            progress_.note(fmt::format("{} elements to export, {:.3f}% from the function by themselves",
                                       solution_.interpolant.tree.leaves().size(), 100 * own));
        }
        const EnergyBalance energy = statistics().energy = energy_balance(solution_, direct_, stage_);
        if (energy.emitted > 0 && energy.absorbed == 0 && !stop_.requested())
            warn("no light reaches the front of any face: they may be turned inside out");
        statistics().seconds["reconstruct"] += watch.seconds() - mesh_seconds_;
    }

    Plan plan_;
    SolveOptions& options_ = plan_.options;  ///< As asked for, with the method that was chosen.
    Knobs& knobs_ = plan_.knobs;             ///< Of this attempt.
    const bool &has_links_ = plan_.has_links, &sums_ = plan_.sums;
    Progress& progress_;
    const StopRequest& stop_;
    CheckpointStore* checkpoints_;
    Solution solution_;
    Stage stage_;
    DirectProjection direct_;
    std::optional<GlobalLight> light_;  ///< What the method found; none when it is to be found anew.
    std::optional<LocalPass> local_pass_;
    std::vector<ElementFunction> refined_;  ///< What is gathered in the end where light is summed, in parts.
    LocalPassReport gathered_;
    Certificate certificate_;
    int attempt_ = 1;
    Step step_ = Step::project;
    bool fresh_ = true;             ///< Does the method find new light in this attempt?
    bool becomes_linear_ = false;   ///< What the method `matrix` takes for granted.
    Spectrum share_;                ///< c of that light, see find_direct_share.
    std::vector<double> light_in_;  ///< Of every room by the mean light; empty where all is one room.
    std::string resumed_phase_;
    double mesh_seconds_ = 0;  ///< Of the discontinuity mesh and its light.
};

/// Direct light, links and gather apart from the mesh, the solve and the reconstruction that they are parts of.
void part_times(const PhaseTimes& phases, std::map<std::string, double>& seconds) {
    const auto move = [&](double part, const char* from, const char* to) {
        const double moved = std::min(part, seconds[from]);
        seconds[from] -= moved, seconds[to] += moved;
    };
    move(phases.seconds({"direct light"}), "mesh", "direct");
    move(phases.seconds({"link", "refine", "look again", "correct", "check by rays"}), "solve", "link");
    move(phases.seconds({"gather"}), "reconstruct", "gather");
}

}  // namespace

Result<Solution> solve_scene(Scene scene, const SolveOptions& options, Progress& progress, const StopRequest& stop,
                             CheckpointStore* checkpoints) {
    if (options.threads > 0) set_threads(options.threads);
    set_schedule(options.schedule);
    if (const Result<void> passes = check_diffusing_panes(scene, options); !passes) return passes.error();
    if (options.local_pass.value_or(LocalPassRule::e) != LocalPassRule::e)
        return solve_by_lines(scene, options, progress, stop);
    if (options.task_engine) return solve_by_tasks(scene, options, progress, stop);
    const Stopwatch watch;
    PhaseTimes phases(progress);
    Result<Solution> solution = Solver(std::move(scene), options, phases, stop, checkpoints).run();
    if (!solution) return solution;
    phases.close();
    part_times(phases, solution->statistics.seconds);
    solution->statistics.seconds["total"] = watch.seconds();
    solution->statistics.peak_memory_bytes = peak_memory_bytes();
    return solution;
}

}  // namespace exitance
