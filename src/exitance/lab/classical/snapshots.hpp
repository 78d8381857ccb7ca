#pragma once

#include <algorithm>
#include <ctime>
#include <utility>

#include "exitance/lab/classical/classical.hpp"

namespace exitance {

struct ClassicalLight;

/// Watches a solve, and hands over what there is when a snapshot of the plan is due. Writing does not count as the
/// method's time.
class Snapshots {
  public:
    /// What a method has found, and how long that took.
    struct Moment {
        const ClassicalLight& light;
        std::size_t number;                 ///< From 1.
        double seconds, processor_seconds;  ///< Of the method alone.
    };
    using Sink = std::function<Result<void>(const Moment& moment)>;

    Snapshots(SnapshotPlan plan, Sink sink) : plan_(std::move(plan)), sink_(std::move(sink)) {
        std::sort(plan_.seconds.begin(), plan_.seconds.end());
        std::sort(plan_.shots.begin(), plan_.shots.end());
    }

    /// After so many shots. `light()`, what there is and what it took, is called where a snapshot is due.
    template <class Light>
    void after_shot(std::size_t shots, const Light& light) {
        bool due = is_time();
        for (; shot_ < plan_.shots.size() && plan_.shots[shot_] <= shots; ++shot_) due = true;
        if (due) take(light);
    }
    /// After a sweep or an iteration.
    template <class Light>
    void after_round(const Light& light) {
        const bool due = is_time();
        if (due || plan_.rounds) take(light);
    }

    const Result<void>& written() const { return written_; }
    double seconds() const { return watch_.seconds() - writing_; }
    double processor_seconds() const { return processor_clock() - begun_ - processor_writing_; }
    /// Spent on writing so far.
    double writing() const { return writing_; }

  private:
    /// Seconds of all processors since the program began.
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
