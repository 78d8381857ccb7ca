#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <string_view>

namespace exitance {

/// Where long work says how far it is, and asks whether to go on. One object serves one run; the terminal derives its
/// own. Calls come from the thread that drives a phase, never from inside parallel loops.
class Progress {
  public:
    virtual ~Progress() = default;

    /// A phase begins ("link", "solve", ...).
    virtual void phase(std::string_view /*name*/) {}
    /// `fraction` of the present phase is done, in [0, 1]; `detail` is a few words such as "residual 3e-4".
    virtual void advance(double /*fraction*/, std::string_view /*detail*/ = {}) {}
    /// What a step has found, for those who ask for details (`-v`).
    virtual void note(std::string_view /*message*/) {}
    /// A finding the user should see, once.
    virtual void warn(std::string_view /*message*/) {}
};

/// Asked at safe points: has a signal or a time limit asked the work to stop? Safe to ask from any thread.
class StopRequest {
  public:
    using Clock = std::chrono::steady_clock;

    /// Async-signal-safe.
    void interrupt() { interrupted_at_.store(Clock::now().time_since_epoch().count(), std::memory_order_relaxed); }
    void set_deadline(Clock::time_point deadline) { deadline_ = deadline; }

    bool interrupted() const { return interrupted_at_.load(std::memory_order_relaxed) != 0; }
    bool out_of_time() const { return Clock::now() >= deadline_; }
    /// Until the deadline; infinite when there is none, below 0 when it has passed.
    double seconds_left() const {
        if (deadline_ == Clock::time_point::max()) return std::numeric_limits<double>::infinity();
        return std::chrono::duration<double>(deadline_ - Clock::now()).count();
    }
    bool requested() const { return interrupted() || out_of_time(); }
    /// Since the stop was asked for; 0 or less when it was not. For work that uses what little time is left.
    double seconds_overdue() const {
        const Clock::time_point at{Clock::duration(interrupted_at_.load(std::memory_order_relaxed))};
        const double interrupt = interrupted() ? std::chrono::duration<double>(Clock::now() - at).count() : 0;
        return std::max(interrupt, -seconds_left());
    }

  private:
    std::atomic<Clock::rep> interrupted_at_{0};  ///< As a clock tells it; 0: not.
    Clock::time_point deadline_ = Clock::time_point::max();
};

/// Seconds since it was made or last restarted.
class Stopwatch {
  public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
    double restart() {
        const double elapsed = seconds();
        start_ = std::chrono::steady_clock::now();
        return elapsed;
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace exitance
