#pragma once

#include <algorithm>
#include <utility>

#include "exitance/methods/classical/classical.hpp"

namespace exitance {

/// Watches a solve, and hands over what there is when a snapshot of the plan is due. Writing does not count as the
/// method's time.
class Snapshots {
  public:
    using Sink = std::function<Result<void>(const ElementFunction& irradiance, std::size_t number)>;

    Snapshots(SnapshotPlan plan, Sink sink) : plan_(std::move(plan)), sink_(std::move(sink)) {
        std::sort(plan_.seconds.begin(), plan_.seconds.end());
        std::sort(plan_.shots.begin(), plan_.shots.end());
    }

    /// After so many shots. `irradiance()` is called where a snapshot is due.
    template <class Irradiance>
    void after_shot(std::size_t shots, const Irradiance& irradiance) {
        bool due = is_time();
        for (; shot_ < plan_.shots.size() && plan_.shots[shot_] <= shots; ++shot_) due = true;
        if (due) take(irradiance());
    }
    /// After a sweep or an iteration.
    template <class Irradiance>
    void after_round(const Irradiance& irradiance) {
        const bool due = is_time();
        if (due || plan_.rounds) take(irradiance());
    }

    const Result<void>& written() const { return written_; }
    double seconds() const { return watch_.seconds() - writing_; }

  private:
    bool is_time() {
        bool due = false;
        for (; second_ < plan_.seconds.size() && plan_.seconds[second_] <= seconds(); ++second_) due = true;
        return due;
    }
    void take(const ElementFunction& irradiance) {
        if (!sink_ || !written_) return;
        const Stopwatch writing;
        written_ = sink_(irradiance, ++taken_);
        writing_ += writing.seconds();
    }

    SnapshotPlan plan_;
    Sink sink_;
    Stopwatch watch_;
    double writing_ = 0;
    std::size_t second_ = 0, shot_ = 0, taken_ = 0;
    Result<void> written_;
};

}  // namespace exitance
