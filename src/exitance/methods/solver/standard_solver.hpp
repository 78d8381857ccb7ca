#pragma once

#include "exitance/error/tolerance/accuracy.hpp"
#include "exitance/evaluate/interpolant.hpp"
#include "exitance/methods/extensions.hpp"
#include "exitance/methods/light/next_light.hpp"
#include "exitance/methods/light/unscaled_light.hpp"
#include "exitance/methods/solver/body_demand.hpp"
#include "exitance/methods/solver/solver.hpp"

namespace exitance {

/// A solve in the standard form: exact direct light, a method, a final gather and an error estimate, in attempts until
/// the estimated error is small enough (`attempts.cpp`). `delivery.cpp` computes and delivers the light of an attempt,
/// and `output.cpp` creates the exported mesh.
class StandardSolver final : public Solver {
  public:
    StandardSolver(Scene scene, const SolveOptions& asked, Progress& progress, const StopRequest& stop,
                   CheckpointStore* checkpoints, const ShowLight& show, ShowLight shows_layers);

  private:
    Result<void> fit_memory() override;
    void find_light() override;
    void make_exported_mesh() override;
    void record_energy() override;
    int attempt_limit() const override { return max_attempts + attempts_before_; }
    bool is_intermediate() const override { return options_.error && *options_.error > requested_error_; }
    void archive_own(ArchiveReader& a) override;
    void archive_own(ArchiveWriter& a) override;
    template <class Archive>
    void archive_attempts(Archive& a);

    static constexpr int max_attempts = 9;

    // Direct light alone.
    /// Projects direct light, for scenes and requests without reflected light.
    void solve_direct_light();
    /// Records the noise of direct light as the error of a solution without indirect light.
    void record_noise_of_direct_light_alone();

    // Attempts: method, local pass and certificate.
    void solve_indirect_light();
    /// Makes one attempt. Keeps the results of the previous one as far as they are accurate enough.
    void attempt();
    /// Returns why the light of the last attempt does not suffice, for a message.
    std::string reason_for_attempt(double demand) const;
    /// Seed of the points at which an attempt is measured: one per attempt, since the previous ones decided how it
    /// refines.
    std::uint64_t certificate_seed() const;
    /// Returns the parts of the error where it is largest.
    ErrorParts error_parts() const;
    /// Returns the part of the error that is not due to the local pass.
    double not_local(const ErrorParts& parts) const;

    // Another attempt.
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
    /// Discards the method's light, so that the next attempt solves again.
    void solve_again() { light_.reset(), next_ = {}, steps_.not_local = 0; }

    // Bodies.
    /// True if the light on every body must be accurate, not only that on all surfaces together.
    bool holds_bodies() const { return options_.error_demand() && options_.importance.empty(); }
    /// True if another attempt follows because the light of some body is too inaccurate. Then changes the settings for
    /// it. `last_seconds`: duration of the last attempt.
    bool refines_bodies(double demand, double last_seconds);

    // Interactive display of intermediate solutions.
    /// Lowers the target error of the attempts if it has been reached. Certifies the present solution again with the
    /// number of rays that the new target needs, since it may already satisfy it. Returns true if another attempt is
    /// needed.
    bool lower_error();
    /// Passes the delivered light to the `show` callback, on the elements of the export.
    void show_light();

    // Steps that compute the light of an attempt.
    void project_direct();
    /// True if a stop now would leave only direct light, without an estimate of its error. Such light is not delivered.
    bool light_is_dropped_at_stop() const;
    /// Projects direct light on a coarse mesh, for when no time is left for a discontinuity mesh.
    void project_coarsely();
    /// Returns true if there is enough memory for the method on the projected elements. Otherwise sets `refusal_`.
    bool has_memory();
    void choose_basis();
    void find_method_light();
    void take_two_grid_step();
    bool corrects_sums() const { return gathers() && sums_ && knobs_.corrects_sums; }
    /// Returns functions as element gathers; empty if light is sampled by rays.
    std::vector<ElementGather> parts_to_sum(std::span<const ElementFunction> functions) const;
    /// Returns the input of a refinement step on a function gathered from the method's light.
    RefinementInput refinement_of(const ElementFunction& indirect) const;
    Spectrum direct_share() const;

    // The delivered function.
    /// Computes indirect light on all surfaces by gathering `b` and delivers it. `elements`: `b` as element gathers, if
    /// light is summed. `fresh`: `b` is neither the light gathered last nor a small change of it. Returns false if a
    /// stop request interrupted the gather.
    bool deliver(std::span<const ElementGather> elements, const ReadNextLight& b, bool fresh);
    ElementFunction gather(const ReadNextLight& b, std::span<const ElementGather> elements, bool fresh);
    /// Makes a function the delivered one. `kept`: factor by which it was scaled.
    void adopt(ElementFunction indirect, const Spectrum& kept);
    /// Delivers the method's solution on its own elements.
    void adopt_method_light();
    /// Returns the unscaled share (`UnscaledShare::indirect`) of `solution_.indirect`, which was scaled by `kept` after
    /// the gather.
    Spectrum unscaled_indirect(const Spectrum& kept) const;

    // Exported mesh.
    bool makes_discontinuity_mesh() const;
    /// Computes direct light on triangles that follow its shadows, and adds the reflected light. Returns false if a
    /// stop request left no time for any triangles; plain elements are then exported.
    bool make_discontinuity();
    /// Passes the solution with the layers of the sources so far to `shows_layers_`.
    ShowLayers show_layers() const;
    /// Warns if more is left out than the mesh follows, and the user did not choose the shadow lines.
    void warn_of_lines();
    /// Returns the light to which the error of exported elements is relative, W/m^2.
    double interpolant_scale() const;
    /// Returns direct plus reflected light as plain elements, with an error in proportion to the target error of the
    /// attempts.
    ElementFunction plain_elements(InterpolantReport& report, Progress* progress = nullptr) const;

    const ShowLight shows_layers_;  ///< Receives a snapshot after each source of --layers, if requested; else empty.
    double requested_error_ = 0;  ///< Requested error; options_.error is larger while intermediate solutions are shown.
    BodyDemand body_demand_;
    bool fresh_ = true;       ///< True if the method solves in this attempt.
    Spectrum share_;          ///< c of the method's light, see find_direct_share.
    UnscaledShare unscaled_;  ///< Unscaled share of the delivered light.
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
};

}  // namespace exitance
