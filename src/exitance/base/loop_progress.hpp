#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <string>
#include <thread>
#include <utility>

#include "exitance/base/progress.hpp"

namespace exitance {

/// Reports how far a parallel loop is. All threads count their items; the thread that created the object, which drives
/// the phase and takes part in the loop, passes the count on to the Progress, at most ten times a second.
class LoopProgress {
  public:
    /// `progress`: receives the reports; null: nobody. `count`: items of the loop. The loop is the part of its phase
    /// from the fraction `from` to the fraction `to`. `detail`: as in Progress::advance.
    LoopProgress(Progress* progress, std::size_t count, double from = 0, double to = 1, std::string detail = {})
        : progress_(progress),
          count_(static_cast<double>(std::max<std::size_t>(1, count))),
          from_(from),
          to_(to),
          detail_(std::move(detail)) {}
    LoopProgress(const LoopProgress&) = delete;
    LoopProgress& operator=(const LoopProgress&) = delete;

    /// Counts one more item as done. Thread-safe.
    void add_one() {
        const std::size_t done = 1 + done_.fetch_add(1, std::memory_order_relaxed);
        if (!progress_ || std::this_thread::get_id() != driver_ || watch_.seconds() < min_interval) return;
        watch_.restart();
        progress_->advance(from_ + (to_ - from_) * static_cast<double>(done) / count_, detail_);
    }

  private:
    static constexpr double min_interval = 0.1;  ///< Seconds between reports, as often as a bar is drawn.
    Progress* progress_;
    double count_, from_, to_;
    std::string detail_;
    std::thread::id driver_ = std::this_thread::get_id();
    std::atomic<std::size_t> done_{0};
    Stopwatch watch_;  ///< Used by the driving thread only.
};

/// Fraction of a phase that is done before round `round`, from 0, if the number of rounds is unknown: each round is
/// taken as half of what is left.
inline double fraction_before_round(int round) {
    double left = 1;
    for (int i = 0; i < round; ++i) left /= 2;
    return 1 - left;
}

}  // namespace exitance
