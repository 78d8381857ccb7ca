#pragma once

#include "exitance/error/certificate.hpp"
#include "exitance/evaluate/interpolant.hpp"
#include "exitance/evaluate/quick_function.hpp"
#include "exitance/gather/element_gather.hpp"
#include "exitance/gather/local_pass.hpp"
#include "exitance/methods/light/next_light.hpp"
#include "exitance/methods/light/unscaled_light.hpp"
#include "exitance/methods/plan/plan.hpp"
#include "exitance/methods/solve_scene.hpp"

namespace exitance {

/// One run of `solve_scene`: the state that its steps share and that checkpoints keep. `solver.cpp` takes the steps and
/// keeps the state, `attempts.cpp` finds and delivers light, `estimate.cpp` says how wrong it is, `output.cpp` makes
/// what is exported.
class Solver {
  public:
    Solver(Scene scene, const SolveOptions& asked, Progress& progress, const StopRequest& stop,
           CheckpointStore* checkpoints, const ShowLight& show);
    Result<Solution> run();

  private:
    /// What comes next within an attempt.
    enum class Step : std::uint8_t { project, solve, gather, refine, certify, decide, output };

    // The state, and what is told of it.
    SolveStatistics& statistics() { return solution_.statistics; }
    void record_plan();
    /// All that the steps to come depend on; `phase` is the state within a step, or empty.
    template <class Archive>
    void archive_state(Archive& a, std::string& phase);
    void resume();
    void keep(std::string phase);
    /// Everything before this step is done.
    void reach(Step step);
    /// For the step that is running.
    SafePoints safe_points();
    void warn(std::string message);
    /// Nothing reflects any light, and direct light is exact.
    void tell_exact();
    void stop_early(const char* why);

    static constexpr int most_attempts = 9;

    // Light that is shown while it improves.
    /// Lowers the error that attempts aim at, where that is reached. Where it is certified anew at the error requested,
    /// by as many rays as that takes, no attempt is needed for nothing.
    /// Returns whether it has to be reached by another attempt.
    bool lower_error();
    /// Passes on what is delivered, as plain elements.
    void show_light();

    // Attempts: method, local pass, certificate, until the certificate is content.
    void solve_indirect_light();
    /// One attempt: what the last one found is kept as far as it is good enough.
    void attempt();
    void project_direct();
    /// Is there memory for the method on what was projected? Else `refusal_` is set.
    bool has_memory();
    /// Plain elements for when no time is left for a mesh that follows shadows.
    void project_coarsely();
    void find_light();
    void choose_basis();
    /// Another attempt: its knobs, and how it is made. One step of refinement on from what is delivered (`next_light`)
    /// takes neither finer elements nor rows of the method, and of the gather what changes: it is taken where the
    /// method is to blame and a forecast says that less work leads there so.
    struct NextAttempt {
        Tightened finer;
        bool is_step = false;
        std::string forecast = {};  ///< In words, where there was a choice.
    };
    NextAttempt next_attempt(double demand) const;
    /// The same, aimed at what is asked for or at as little above it as there is time for, where the last one took so
    /// many seconds. None where there is time for none that is worth it.
    std::optional<NextAttempt> next_in_time(double demand, double last_seconds) const;
    /// What of the error is not of the local pass.
    double not_local(const ErrorParts& parts) const;
    void take_step();
    /// Of an attempt, with its estimate.
    bool has_light() const { return certificate_.points > 0; }
    /// Once a stop is asked for, what another attempt has found stands.
    bool gives_up() const { return stop_.requested() && has_light(); }

    // The function that is delivered.
    /// Light everywhere, from what there is to gather: `b`, as elements where those are summed. `fresh`: it is not what
    /// was gathered last, nor changed by little from that. False when a request to stop cut that short.
    bool deliver(std::span<const ElementGather> elements, const ReadNextLight& b, bool fresh);
    /// A function becomes what is delivered; `kept`: what it was scaled by.
    void adopt(ElementFunction indirect, const Spectrum& kept);
    /// The same of what the method found, on its own elements.
    void adopt_method_light();
    ElementFunction gather(const ReadNextLight& b, std::span<const ElementGather> elements, bool fresh);
    ElementFunction on_leaves() const;
    /// Functions as elements to be summed over; none where light is found by rays.
    std::vector<ElementGather> parts_to_sum(std::span<const ElementFunction> functions) const;
    /// One step on from what is delivered.
    std::vector<ElementFunction> refine() const;
    Spectrum direct_share() const;
    /// Is the method's light gathered once more, or are its elements what is delivered?
    bool gathers() const { return !light_->holds_direct && !light_->delivers && !options_.smoothing; }
    bool refines() const { return gathers() && sums_ && knobs_.refined; }
    /// Is it known how much light is to arrive? As the method tells, or because the scene is closed.
    bool keeps_flux() const;
    /// Of `solution_.indirect`, where it was scaled by `kept` after it was gathered.
    Spectrum unscaled_indirect(const Spectrum& kept) const;

    // How wrong it is.
    /// The estimate by so many points is itself uncertain, by a fifth where they are as few as at first: it has to be
    /// below this share of the demand.
    static double margin(std::size_t points);
    void certify_solution(CertificateOptions options, std::optional<double> demand = {},
                          std::span<const ElementGather> gathered = {});
    bool has_reached(double demand) const { return certificate_.largest() <= margin(certificate_.points) * demand; }
    /// Is this attempt surely the last, or may a limit make it the last?
    bool may_be_last(double demand) const;
    /// Direct light at points is exact, or within this where emitters are many.
    void add_clustering_error();
    /// Where direct light is all there is.
    void tell_clustering_error();
    /// Warns of the body whose light is more than three times as wrong as requested.
    void warn_of_bodies();
    /// What the estimate is made of, relative to the mean reflected light.
    ErrorParts error_parts() const;
    ErrorParts mean_error_parts() const;

    // What is exported.
    bool makes_discontinuity_mesh() const;
    /// Direct light on triangles that follow its shadows, with what is reflected on top of it. False where a request to
    /// stop left no time for any: then plain elements are made.
    bool make_discontinuity();
    void make_output_mesh();
    /// What the error of exported elements is relative to, W/m^2.
    double interpolant_scale() const;
    /// Direct and reflected light together as plain elements that meet the error that attempts aim at.
    ElementFunction plain_elements(InterpolantReport& report) const;

    Plan plan_;
    SolveOptions& options_ = plan_.options;  ///< As asked for, with the method that was chosen.
    Knobs& knobs_ = plan_.knobs;             ///< Of this attempt.
    const bool &has_links_ = plan_.has_links, &sums_ = plan_.sums;
    Progress& progress_;
    const StopRequest& stop_;
    CheckpointStore* checkpoints_;
    const ShowLight& show_;
    std::optional<Error> refusal_;  ///< The method was not started, since it needs more memory than there is.
    double requested_error_ = 0;    ///< options_.error is above it while light is shown and improves.
    int shown_ = 0;                 ///< Attempts that aimed at a larger error.
    Solution solution_;
    Stage stage_;
    DirectProjection direct_;
    UnscaledShare unscaled_;            ///< Of the light that is delivered.
    std::optional<GlobalLight> light_;  ///< What the method found; none when it is to be found anew.
    std::optional<LocalPass> local_pass_;
    std::vector<ElementFunction> refined_;  ///< What is gathered in the end where light is summed, in parts.
    NextLight next_;           ///< What is gathered where that is a step on from what was delivered; else no parts.
    bool takes_step_ = false;  ///< Does this attempt begin with such a step?
    /// What forecasts of another step rest on.
    struct {
        double not_local = 0;         ///< What `not_local` was before the last one; 0: none was taken.
        std::size_t gather_rays = 0;  ///< The most that one attempt has gathered by.
        Spectrum sent;  ///< W, what arrives of the light that was gathered last; 0 where that is not known.
    } steps_;
    LocalPassReport gathered_;
    Certificate certificate_;
    int attempt_ = 1;
    Step step_ = Step::project;
    bool fresh_ = true;                  ///< Does the method find new light in this attempt?
    Spectrum share_;                     ///< c of that light, see find_direct_share.
    std::optional<SceneBodies> bodies_;  ///< By which errors are told; found when they are first needed.
    std::vector<double> light_in_;       ///< Of every room by the mean light; empty where all is one room.
    std::vector<double> allowed_in_;     ///< What errors rooms may have, in proportion (`allowed_by_room`).
    std::string resumed_phase_;
    double mesh_seconds_ = 0;  ///< Of the discontinuity mesh and its light.
};

}  // namespace exitance
