#pragma once

#include "exitance/base/phase_times.hpp"
#include "exitance/error/certificate.hpp"
#include "exitance/evaluate/interpolant.hpp"
#include "exitance/evaluate/quick_function.hpp"
#include "exitance/gather/element_gather.hpp"
#include "exitance/gather/local_pass.hpp"
#include "exitance/methods/light/next_light.hpp"
#include "exitance/methods/light/unscaled_light.hpp"
#include "exitance/methods/method_entry.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/methods/plan/plan.hpp"
#include "exitance/methods/solve_scene.hpp"

namespace exitance {

/// State and steps of one run of `solve_scene`. `solver.cpp` runs the steps and saves and restores the state,
/// `attempts.cpp` computes and delivers the light, `published.cpp` that of published forms, `estimate.cpp` estimates
/// its error, and `output.cpp` creates the exported mesh.
class Solver {
  public:
    Solver(Scene scene, const SolveOptions& asked, Progress& progress, const StopRequest& stop,
           CheckpointStore* checkpoints, const ShowLight& show);
    Result<Solution> run();

  private:
    /// Next step of an attempt.
    enum class Step : std::uint8_t { project, solve, gather, correct_sums, certify, decide, output };

    /// Coarsens the settings until the predicted memory is within the limit. An error if even the coarsest ones exceed
    /// it.
    Result<void> fit_memory();
    /// Projects direct light, for scenes and requests without reflected light.
    void solve_direct_light();

    // State, checkpoints and messages.
    SolveStatistics& statistics() { return solution_.statistics; }
    void record_plan();
    /// Archives everything on which the remaining steps depend. `phase`: the state within the present step, or empty.
    template <class Archive>
    void archive_state(Archive& a, std::string& phase);
    void resume();
    void keep(std::string phase);
    /// Sets the next step; saves a checkpoint if one is due.
    void reach(Step step);
    /// Returns the safe points of the present step.
    SafePoints safe_points();
    void warn(std::string message);
    /// Records an error of zero: nothing reflects, and direct light is exact.
    void record_zero_error();
    /// Records an error of zero if no surface reflects direct light. Otherwise the method has lost the light, and
    /// `refusal_` is set.
    void record_darkness();
    void stop_early(StopReason why);
    /// Records that a stop was requested, as an interrupt or a time limit.
    void stop_as_requested() { stop_early(stop_.interrupted() ? StopReason::interrupt : StopReason::time_limit); }

    static constexpr int max_attempts = 9, max_published_attempts = 4;
    int attempt_limit() const { return is_published() ? max_published_attempts : max_attempts + shown_; }

    // Interactive display of intermediate solutions.
    /// Lowers the target error of the attempts if it has been reached. Certifies the present solution again with the
    /// number of rays that the new target needs, since it may already satisfy it. Returns true if another attempt is
    /// needed.
    bool lower_error();
    /// True if another attempt follows because the light of some body is too inaccurate. Then changes the settings for
    /// it. `last_seconds`: duration of the last attempt.
    bool refines_bodies(double demand, double last_seconds);
    /// Reduces the errors allowed on the bodies whose error exceeds `limit`: of the light gathered on them before a
    /// refinement step, of the direct light that they see before a new solve.
    void tighten_bodies(double limit);
    /// Passes the delivered light to the `show` callback, on the elements of the export.
    void show_light();
    /// Passes the light of a published form to the `show` callback.
    void show_snapshot(const Snapshots::Moment& moment);

    // Attempts: method, local pass and certificate, until the estimated error is small enough.
    void solve_indirect_light();
    /// Makes one attempt. Keeps the results of the previous one as far as they are accurate enough.
    void attempt();
    void project_direct();
    /// Returns true if there is enough memory for the method on the projected elements. Otherwise sets `refusal_`.
    bool has_memory();
    /// Projects direct light on a coarse mesh, for when no time is left for a discontinuity mesh.
    void project_coarsely();
    void find_light();
    void choose_basis();
    /// Settings and kind of another attempt. A refinement step on the delivered light (`next_light`) needs no finer
    /// elements and no new matrix rows; it gathers only the change of the light. It is chosen if the method's part of
    /// the error is too large and a forecast finds the step cheaper.
    struct NextAttempt {
        Tightened finer;
        bool is_step = false;
        std::string forecast = {};  ///< Message about the forecast; empty if there was no choice.
    };
    NextAttempt next_attempt(double demand) const;
    /// Like `next_attempt`, but aims at the smallest error that is at least `demand` and for which there is enough
    /// time. `last_seconds`: duration of the last attempt. Empty if there is no time for a useful attempt.
    std::optional<NextAttempt> next_in_time(double demand, double last_seconds) const;
    /// Returns the part of the error that is not due to the local pass.
    double not_local(const ErrorParts& parts) const;
    /// Lets rooms that are accurate enough keep their noise when settings for the others are tightened. `step`: factor
    /// on the allowed noise.
    void keep_noise_of_accurate_rooms(double target, double step);
    void take_two_grid_step();
    /// Returns true if an attempt has delivered light with an error estimate.
    bool has_light() const { return certificate_.points > 0; }
    /// True if a stop was requested and an earlier attempt has a result to keep.
    bool gives_up() const { return stop_.requested() && has_light(); }

    // Published forms: the light of the form, a gather if requested, and a certificate if the form has one.
    bool is_published() const { return form_of(options_) != Form::standard; }
    void solve_published();
    void attempt_published();
    /// Aims at a smaller error if there is time for another attempt. `last_seconds`: duration of the last one.
    bool aim_lower(double demand, double last_seconds);
    /// Records why a published form ended early, unless it did not.
    void record_end();
    /// Stores the light and the counts of a published form in a solution.
    void take_published(const GlobalLight& light, Solution& solution) const;
    /// Records the time since the form began.
    void record_method_time(double seconds, double processor_seconds, SolveStatistics& statistics) const;
    /// Smooths the light of a published form if that is requested, and makes its exported mesh. Returns the direct
    /// light on that mesh; without elements if the form's light contains it.
    DirectProjection make_published_mesh(Solution& solution) const;
    /// Gathers the light of a published form once.
    ElementFunction gather_published();
    /// Estimates the error of light that contains that of emitters.
    void certify_published();
    /// Returns the smaller of the requested errors of the light and of the exported mesh, which are one here.
    std::optional<double> published_demand() const;

    // The delivered function.
    /// Computes indirect light on all surfaces by gathering `b` and delivers it. `elements`: `b` as element gathers, if
    /// light is summed. `fresh`: `b` is neither the light gathered last nor a small change of it. Returns false if a
    /// stop request interrupted the gather.
    bool deliver(std::span<const ElementGather> elements, const ReadNextLight& b, bool fresh);
    /// Makes a function the delivered one. `kept`: factor by which it was scaled.
    void adopt(ElementFunction indirect, const Spectrum& kept);
    /// Delivers the method's solution on its own elements.
    void adopt_method_light();
    ElementFunction gather(const ReadNextLight& b, std::span<const ElementGather> elements, bool fresh);
    ElementFunction on_leaves(const GlobalLight& light) const;
    /// Settings of a gather for light whose mean is `scale`, W/m^2.
    LocalPassDemand gather_demand(double scale) const;
    /// Returns functions as element gathers; empty if light is sampled by rays.
    std::vector<ElementGather> parts_to_sum(std::span<const ElementFunction> functions) const;
    /// Returns the light to gather after one refinement step on the delivered light, in parts (`corrected_sums`).
    std::vector<ElementFunction> corrected_sums() const;
    Spectrum direct_share() const;
    /// True if the method's light is gathered; false if its elements are delivered.
    bool gathers() const { return light_->delivery == MethodDelivery::gathered && !options_.smoothing; }
    /// True if the light on every body must be accurate, not only that on all surfaces together.
    bool holds_bodies() const { return options_.error_demand() && options_.importance.empty(); }
    const SceneBodies& bodies();
    bool corrects_sums() const { return gathers() && sums_ && knobs_.corrects_sums; }
    /// True if the amount of arriving light is known: because the method conserves light or the scene is closed.
    bool keeps_flux() const;
    /// Returns the unscaled share (`UnscaledShare::indirect`) of `solution_.indirect`, which was scaled by `kept` after
    /// the gather.
    Spectrum unscaled_indirect(const Spectrum& kept) const;

    // Error estimate.
    /// Returns the share of the demand below which an estimate from this many points must be. The estimate is itself
    /// uncertain: by a fifth with the initial number of points, by less with more.
    static double margin(std::size_t points);
    /// Seed of the points at which an attempt is measured: one per attempt, since the previous ones decided how it
    /// refines.
    std::uint64_t certificate_seed() const;
    void certify_solution(CertificateOptions options, std::optional<double> demand = {},
                          std::span<const ElementGather> gathered = {});
    bool has_reached(double demand) const { return certificate_.largest() <= margin(certificate_.points) * demand; }
    /// True if this attempt is the last one, or may become the last one due to a limit.
    bool may_be_last(double demand) const;
    /// Noise of direct light that rays evaluate at points, relative to the mean reflected light; 0 if all of it is
    /// exact.
    double direct_light_noise_share() const;
    /// Records the noise of direct light as the error of a solution without indirect light.
    void record_noise_of_direct_light_alone();
    /// Warns of the worst body if its error is more than three times the requested one.
    void warn_of_bodies();
    void warn_of_hidden_errors();
    ErrorParts error_parts() const;

    // Exported mesh.
    bool makes_discontinuity_mesh() const;
    /// Computes direct light on triangles that follow its shadows, and adds the reflected light. Returns false if a
    /// stop request left no time for any triangles; plain elements are then exported.
    bool make_discontinuity();
    /// Warns if more is left out than the mesh follows, and the user did not choose the shadow lines.
    void warn_of_lines();
    void make_output_mesh();
    /// Returns the light to which the error of exported elements is relative, W/m^2.
    double interpolant_scale() const;
    /// Returns direct plus reflected light as plain elements, with an error in proportion to the target error of the
    /// attempts.
    ElementFunction plain_elements(InterpolantReport& report) const;

    Plan plan_;
    SolveOptions& options_ = plan_.options;  ///< Requested options, with the chosen method.
    Knobs& knobs_ = plan_.knobs;             ///< Settings of the present attempt.
    const bool &has_links_ = plan_.has_links, &sums_ = plan_.sums;
    const StopRequest& stop_;
    CheckpointStore* checkpoints_;
    const ShowLight& show_;
    std::optional<Error> refusal_;  ///< Set if the method needs more memory than available, or found no light.
    double requested_error_ = 0;  ///< Requested error; options_.error is larger while intermediate solutions are shown.
    int shown_ = 0;               ///< Number of attempts with a larger target error.
    Solution solution_;
    PhaseTimes progress_;  ///< Records the times of the phases in the solution.
    Stage stage_;
    DirectProjection direct_;
    UnscaledShare unscaled_;            ///< Unscaled share of the delivered light.
    std::optional<GlobalLight> light_;  ///< Solution of the method; empty: the method must solve (again).
    std::optional<LocalPass> local_pass_;
    /// Parts of the refined light, which is gathered last if light is summed.
    std::vector<ElementFunction> corrected_;
    NextLight next_;                 ///< Light to gather after a refinement step; has no parts in other attempts.
    bool starts_with_step_ = false;  ///< True if this attempt starts with a refinement step.
    /// Data for forecasting another refinement step.
    struct {
        double not_local = 0;         ///< `not_local` before the last refinement step; 0: there was none.
        std::size_t gather_rays = 0;  ///< Largest number of rays of the gathers of one attempt.
        Spectrum sent;                ///< Arriving power of the light gathered last, W; 0: unknown.
    } steps_;
    BrightPlaces bright_;  ///< Bright places of the light that is gathered, at which rays are aimed.
    LocalPassReport gathered_;
    Certificate certificate_;
    double aim_ = default_error;          ///< Error at which an attempt of a published form aims.
    std::optional<Snapshots> snapshots_;  ///< Set for published forms.
    int attempt_ = 1;
    int body_attempts_ = 0;         ///< Number of attempts that were made because a body was too inaccurate.
    double worst_body_before_ = 0;  ///< Value of `worst_body` before the last of these attempts; 0: there was none.
    /// Factors on the errors that bodies may have due to the light gathered on them and to the direct light they see.
    struct BodyShares {
        double gathered = 1, seen = 1;
    };
    std::vector<BodyShares> body_shares_;  ///< Shares of each body; empty unless bodies must be accurate.
    Step step_ = Step::project;
    bool fresh_ = true;                  ///< True if the method solves in this attempt.
    Spectrum share_;                     ///< c of the method's light, see find_direct_share.
    std::optional<SceneBodies> bodies_;  ///< Use bodies().
    std::vector<double> light_in_;       ///< Light of every room over the mean light; empty if the scene is one room.
    std::vector<double> allowed_in_;     ///< Allowed errors of the rooms (`allowed_by_room`).
    std::vector<double> noise_in_;       ///< Factor on the noise of each room (`LocalPassDemand::noise_in`).
    std::string resumed_phase_;
};

}  // namespace exitance
