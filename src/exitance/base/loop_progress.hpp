#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <string>
#include <thread>
#include <utility>

#include "exitance/base/progress.hpp"

namespace exitance {

/// A part of a phase, from the fraction `from` of the phase to the fraction `to`.
struct PhasePart {
    Progress* progress = nullptr;  ///< Receives the reports; null: nobody.
    double from = 0, to = 1;
    std::string detail = {};  ///< A few words, see Progress::advance.
};

/// Reports how far a parallel loop is. All threads count their items; the thread that created the object, which drives
/// the phase and takes part in the loop, passes the count on to the Progress, at most ten times a second.
class LoopProgress {
  public:
    /// `part`: the part of a phase that is this loop. `count`: items that this process counts, which are own_count() in
    /// a loop that is divided among processes.
    LoopProgress(PhasePart part, std::size_t count)
        : part_(std::move(part)), count_(static_cast<double>(std::max<std::size_t>(1, count))) {}
    LoopProgress(const LoopProgress&) = delete;
    LoopProgress& operator=(const LoopProgress&) = delete;

    /// Counts one more item as done. Thread-safe.
    void add_one() {
        const std::size_t done = 1 + done_.fetch_add(1, std::memory_order_relaxed);
        if (!part_.progress || std::this_thread::get_id() != driver_ || watch_.seconds() < min_interval) return;
        watch_.restart();
        const double share = static_cast<double>(done) / count_;
        part_.progress->advance(part_.from + (part_.to - part_.from) * share, part_.detail);
    }

  private:
    static constexpr double min_interval = 0.1;  ///< Seconds between reports, as often as a bar is drawn.
    PhasePart part_;
    double count_;
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
