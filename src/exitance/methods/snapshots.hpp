#pragma once

#include <algorithm>
#include <ctime>
#include <functional>
#include <utility>

#include "exitance/base/progress.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// Passes intermediate light of a published form to a sink when a snapshot of the plan is due. The sink's time is not
/// part of the form's time.
class Snapshots {
  public:
    /// Intermediate result of a method, and its time so far.
    struct Moment {
        const GlobalLight& light;
        double seconds, processor_seconds;  ///< Time of the method only.
    };
    using Sink = std::function<void(const Moment& moment)>;

    Snapshots(SnapshotPlan plan, Sink sink) : plan_(std::move(plan)), sink_(std::move(sink)) {
        std::sort(plan_.seconds.begin(), plan_.seconds.end());
        std::sort(plan_.shots.begin(), plan_.shots.end());
    }

    /// Must be called after every shot. `shots`: number of shots so far; `light()`: returns the present result, called
    /// only if a snapshot is due.
    template <class Light>
    void after_shot(std::size_t shots, const Light& light) {
        bool due = is_time();
        for (; shot_ < plan_.shots.size() && plan_.shots[shot_] <= shots; ++shot_) due = true;
        if (due) take(light);
    }
    /// Must be called after every sweep or iteration.
    template <class Light>
    void after_round(const Light& light) {
        const bool due = is_time();
        if (due || plan_.rounds) take(light);
    }

    double seconds() const { return watch_.seconds() - writing_; }
    double processor_seconds() const { return processor_clock() - begun_ - processor_writing_; }
    /// Seconds spent in the sink so far.
    double writing() const { return writing_; }

  private:
    /// Seconds of all processors since the start of the program.
    static double processor_clock() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
    bool is_time() {
        bool due = false;
        for (; second_ < plan_.seconds.size() && plan_.seconds[second_] <= seconds(); ++second_) due = true;
        return due;
    }
    template <class Light>
    void take(const Light& light) {
        if (!sink_) return;
        const double seconds = this->seconds(), processor = processor_seconds();
        const Stopwatch writing;
        const double before = processor_clock();
        sink_({light(), seconds, processor});
        writing_ += writing.seconds(), processor_writing_ += processor_clock() - before;
    }

    SnapshotPlan plan_;
    Sink sink_;
    Stopwatch watch_;
    double writing_ = 0, begun_ = processor_clock(), processor_writing_ = 0;
    std::size_t second_ = 0, shot_ = 0;
};

}  // namespace exitance
