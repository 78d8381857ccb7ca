#pragma once

#include "exitance/methods/snapshots.hpp"
#include "exitance/methods/solver/solver.hpp"

namespace exitance {

/// A solve in a published form: the light of the form on its own mesh, a gather if requested, and an error estimate if
/// the form has one. Such a form delivers its light as it is.
class PublishedSolver final : public Solver {
  public:
    using Solver::Solver;

  private:
    Result<void> fit_memory() override { return {}; }  // published forms stop refining at the limit
    void find_light() override;
    void make_exported_mesh() override;
    /// Warns of a form without an error estimate if the share of the emitted power that is missing or in excess is
    /// larger than the requested error (if none is requested: 2%).
    void record_energy() override;
    int attempt_limit() const override { return max_attempts; }
    void archive_own(ArchiveReader& a) override { a(aim_); }
    void archive_own(ArchiveWriter& a) override { a(aim_); }

    static constexpr int max_attempts = 4;

    /// Makes attempts until the error is within `demand`. Without a demand, or without an estimate, one is made.
    void make_attempts(std::optional<double> demand);
    void attempt();
    /// Gathers the light of the form once.
    ElementFunction gather_once();
    /// Estimates the error of light that contains that of emitters.
    void certify_carried_light();
    /// Returns the smaller of the requested errors of the light and of the exported mesh, which are one here.
    std::optional<double> demand() const;
    /// Aims at a smaller error if there is time for another attempt. `last_seconds`: duration of the last one.
    bool aim_lower(double demand, double last_seconds);
    /// Records why the form ended early, unless it did not.
    void record_end();

    /// Stores the light and the counts of the form in a solution.
    void take_light(const GlobalLight& light, Solution& solution) const;
    /// Records the time since the form began.
    void record_method_time(double seconds, double processor_seconds, SolveStatistics& statistics) const;
    /// Smooths the light of the form if that is requested, and makes its exported mesh. Returns the direct light on
    /// that mesh; without elements if the form's light contains it.
    DirectProjection make_mesh(Solution& solution) const;
    /// Passes the light of the form to the `show` callback.
    void show_snapshot(const Snapshots::Moment& moment);

    double aim_ = default_error;  ///< Error at which an attempt aims.
    std::optional<Snapshots> snapshots_;
};

}  // namespace exitance
