#pragma once

#include "exitance/base/phase_times.hpp"
#include "exitance/error/certificate.hpp"
#include "exitance/gather/element_gather.hpp"
#include "exitance/gather/local_pass.hpp"
#include "exitance/gather/lost_light.hpp"
#include "exitance/methods/method_entry.hpp"
#include "exitance/methods/plan/plan.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/methods/solver/room_demand.hpp"

namespace exitance {

/// State and steps that all runs of `solve_scene` share: the plan, checkpoints and messages (`solver.cpp`), and the
/// error estimate (`estimate.cpp`). How the light is found and exported is up to `StandardSolver` and
/// `PublishedSolver`.
class Solver {
  public:
    Solver(Scene scene, const SolveOptions& asked, Progress& progress, const StopRequest& stop,
           CheckpointStore* checkpoints, const ShowLight& show);
    virtual ~Solver() = default;
    Result<Solution> run();

  protected:
    /// Next step of an attempt.
    enum class Step : std::uint8_t { project, solve, gather, correct_sums, certify, decide, output };

    // Steps that depend on the kind of solve.
    /// Coarsens the settings until the predicted memory is within the limit. An error if even the coarsest ones exceed
    /// it.
    virtual Result<void> fit_memory() = 0;
    /// Finds the light and estimates its error, in as many attempts as are needed.
    virtual void find_light() = 0;
    /// Creates the exported mesh and records its error.
    virtual void make_exported_mesh() = 0;
    virtual void record_energy();
    virtual int attempt_limit() const = 0;
    /// True if the attempts aim at a larger error than the requested one, so as to show an intermediate solution.
    virtual bool is_intermediate() const { return false; }
    /// Archives the state of the derived class.
    virtual void archive_own(ArchiveReader& a) = 0;
    virtual void archive_own(ArchiveWriter& a) = 0;

    // State, checkpoints and messages.
    SolveStatistics& statistics() { return solution_.statistics; }
    /// Sets the next step; saves a checkpoint if one is due.
    void reach(Step step);
    /// Returns the safe points of the present step.
    SafePoints safe_points();
    void warn(std::string message);
    /// Records an error of zero: nothing reflects, and direct light is exact.
    void record_zero_error();
    void stop_early(StopReason why);
    /// Records that a stop was requested, and why.
    void stop_as_requested() { stop_early(reason_of(stop_)); }
    /// Records that another attempt, of this many seconds, does not fit into the time left.
    void record_missing_time(double seconds);
    /// Returns true if an attempt has delivered light with an error estimate.
    bool has_light() const { return certificate_.points > 0; }
    /// True if a stop was requested and an earlier attempt has a result to keep.
    bool gives_up() const { return stop_.requested() && has_light(); }

    // The method's light.
    /// Runs the method, and derives from its light what the rooms demand. `aim` and `snapshots`: see `MethodInput`.
    void run_method(double aim, Snapshots* snapshots);
    ElementFunction on_leaves(const GlobalLight& light) const;
    /// True if the method's light is gathered; false if its elements are delivered.
    bool gathers() const { return light_->delivery == MethodDelivery::gathered && !options_.smoothing; }
    /// True if the amount of arriving light is known: because the method conserves light or the scene is closed.
    bool keeps_flux() const;
    /// Light of the method that reaches no front; found when it is first needed.
    const LostLight& lost_light();
    /// Settings of a gather for light whose mean is `scale`, W/m^2.
    LocalPassDemand gather_demand(double scale) const;
    const SceneBodies& bodies();

    // Error estimate.
    /// Returns the share of the demand below which an estimate from this many points must be. The estimate is itself
    /// uncertain: by a fifth with the initial number of points, by less with more.
    static double margin(std::size_t points);
    /// Estimates the error of the delivered light. `demand`: requested error, if further attempts may follow.
    /// `gathered`: the gathered light as element gathers, if light is summed.
    void certify(CertificateOptions options, std::optional<double> demand = {},
                 std::span<const ElementGather> gathered = {});
    /// Returns the error to compare with the demand times `margin`: the largest estimate. If a few points have most of
    /// the error, so that the estimate is more uncertain than `margin` accounts for, it is raised such that its upper
    /// confidence limit is compared with the demand.
    double judged_error() const;
    bool has_reached(double demand) const { return judged_error() <= margin(certificate_.points) * demand; }
    /// Warns of the worst body if its error is more than three times the requested one.
    void warn_of_bodies();
    /// Warns of the worst room if the solve ended although the error of a room was larger than requested.
    void warn_of_rooms();
    /// Advice for the end of a warning about errors that remain, by the reason why the solve ended. `effect`: what the
    /// advised action does, such as "corrects it".
    std::string advice_at_end(std::string_view effect) const;

    Plan plan_;
    SolveOptions& options_ = plan_.options;  ///< Requested options, with the chosen method.
    Knobs& knobs_ = plan_.knobs;             ///< Settings of the present attempt.
    const bool &has_links_ = plan_.has_links, &sums_ = plan_.sums;
    const StopRequest& stop_;
    CheckpointStore* checkpoints_;
    const ShowLight& show_;
    std::optional<Error> refusal_;  ///< Set if the method needs more memory than available, or found no light.
    Solution solution_;
    PhaseTimes progress_;  ///< Records the times of the phases in the solution.
    Stage stage_;
    DirectProjection direct_;
    std::optional<GlobalLight> light_;  ///< Solution of the method; empty: the method must solve (again).
    std::optional<LostLight> lost_;     ///< See `lost_light`.
    std::optional<LocalPass> local_pass_;
    BrightPlaces bright_;  ///< Bright places of the light that is gathered, at which rays are aimed.
    LocalPassReport gathered_;
    Certificate certificate_;
    RoomDemand rooms_;
    bool lacked_time_ = false;  ///< True if the time limit prevented another attempt for the sake of bodies.
    int attempt_ = 1;
    int attempts_before_ = 0;  ///< Number of attempts before the first one: those with a larger target error.
    Step step_ = Step::project;

  private:
    void record_plan();
    /// Replaces the light of the rooms by the delivered light, and sets it and the allowed errors in `options`.
    void set_light_of_rooms(CertificateOptions& options, const Spectrum& direct_weight);
    /// Records the certificate. `noise`: relative error of direct light by rays, which the rooms' errors get as well.
    void record_errors(const Certifier& certifier, double noise);
    /// Archives everything on which the remaining steps depend. `phase`: the state within the present step, or empty.
    template <class Archive>
    void archive_state(Archive& a, std::string& phase);
    void resume();
    void keep(std::string phase);

    /// True if this attempt is the last one, or may become the last one due to a limit.
    bool may_be_last(double demand) const;
    /// Noise of direct light that rays evaluate at points, relative to the mean reflected light; 0 if all of it is
    /// exact.
    double direct_light_noise_share() const;
    /// Records an error of zero if no surface reflects direct light. Otherwise the method has lost the light, and
    /// `refusal_` is set.
    void record_darkness();
    void warn_of_hidden_errors();

    std::optional<SceneBodies> bodies_;  ///< Use bodies().
    std::string resumed_phase_;
};

}  // namespace exitance
