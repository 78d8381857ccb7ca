#pragma once

#include <algorithm>
#include <ctime>
#include <utility>

#include "exitance/lab/classical/classical.hpp"

namespace exitance {

struct ClassicalLight;

/// Passes intermediate results of a solve to a sink when a snapshot of the plan is due. The sink's time is not part of
/// the method's time.
class Snapshots {
  public:
    /// Intermediate result of a method, and its time so far.
    struct Moment {
        const ClassicalLight& light;
        std::size_t number;                 ///< Counted from 1.
        double seconds, processor_seconds;  ///< Time of the method only.
    };
    using Sink = std::function<Result<void>(const Moment& moment)>;

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

    const Result<void>& written() const { return written_; }
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
        if (!sink_ || !written_) return;
        const double seconds = this->seconds(), processor = processor_seconds();
        const Stopwatch writing;
        const double before = processor_clock();
        written_ = sink_({light(), ++taken_, seconds, processor});
        writing_ += writing.seconds(), processor_writing_ += processor_clock() - before;
    }

    SnapshotPlan plan_;
    Sink sink_;
    Stopwatch watch_;
    double writing_ = 0, begun_ = processor_clock(), processor_writing_ = 0;
    std::size_t second_ = 0, shot_ = 0, taken_ = 0;
    Result<void> written_;
};

}  // namespace exitance
