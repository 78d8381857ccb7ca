#pragma once

#include <optional>
#include <string_view>

#include "exitance/base/progress.hpp"
#include "exitance/base/run_seconds.hpp"

namespace exitance {

/// Forwards everything to another Progress and adds the time of every phase to the part of the run that it belongs to.
/// The time before the first phase is not counted. Must not outlive that Progress and the seconds.
class PhaseTimes : public Progress {
  public:
    PhaseTimes(Progress& progress, RunSeconds& seconds) : progress_(progress), seconds_(seconds) {}

    void phase(std::string_view name) override {
        close();
        part_ = part_of(name);
        progress_.phase(name);
    }
    void advance(double fraction, std::string_view detail = {}) override { progress_.advance(fraction, detail); }
    void note(std::string_view message) override { progress_.note(message); }
    void warn(std::string_view message) override { progress_.warn(message); }
    Progress& inner() { return progress_; }

    /// Ends the current phase.
    void close() {
        if (part_) seconds_[*part_] += watch_.seconds();
        watch_.restart();
        part_.reset();
    }

  private:
    /// Returns the part of the run; none for phases whose work is timed in detail elsewhere.
    static std::optional<RunPart> part_of(std::string_view phase) {
        if (phase == "discontinuities") return {};
        if (phase == "mesh") return RunPart::mesh;
        if (phase == "direct light") return RunPart::direct;
        for (const std::string_view links : {"link", "refine", "look again", "correct", "check by rays"})
            if (phase == links) return RunPart::link;
        if (phase == "gather") return RunPart::gather;
        if (phase == "certify") return RunPart::certify;
        if (phase == "reconstruct" || phase == "local pass") return RunPart::reconstruct;
        return RunPart::solve;  // the method's own phases: "shoot", "grow", "solve"
    }

    Progress& progress_;
    RunSeconds& seconds_;
    std::optional<RunPart> part_;
    Stopwatch watch_;
};

}  // namespace exitance
