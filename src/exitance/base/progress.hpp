#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>
#include <string_view>

namespace exitance {

/// Receives progress and messages of long work. One object serves one run; the terminal derives its own class. Calls
/// come from the thread that drives a phase, never from inside parallel loops.
class Progress {
  public:
    virtual ~Progress() = default;

    /// A phase begins ("link", "solve", ...).
    virtual void phase(std::string_view /*name*/) {}
    /// Reports that `fraction`, in [0, 1], of the current phase is done; `detail` is a few words such as "residual
    /// 3e-4".
    virtual void advance(double /*fraction*/, std::string_view /*detail*/ = {}) {}
    /// Reports an intermediate result of a step, shown only with `-v`.
    virtual void note(std::string_view /*message*/) {}
    /// Reports a problem that the user should see, once.
    virtual void warn(std::string_view /*message*/) {}
};

/// A request to stop, by a signal or a time limit; long work checks it at safe points. Thread-safe.
class StopRequest {
  public:
    using Clock = std::chrono::steady_clock;

    /// The cause of a stop: the deadline, a limit on memory, a user (SIGINT, a caller of the library), or SIGTERM. If
    /// several processes stop for different causes, the last one in this order counts.
    enum class Cause : std::uint8_t { none, time_limit, memory_limit, interrupt, termination };

    /// Requests a stop. The cause of the first request is kept. Async-signal-safe.
    void interrupt(Cause cause = Cause::interrupt) {
        Cause none = Cause::none;
        cause_.compare_exchange_strong(none, cause, std::memory_order_relaxed);
        interrupted_at_.store(Clock::now().time_since_epoch().count(), std::memory_order_release);
    }
    void set_deadline(Clock::time_point deadline) { deadline_ = deadline; }

    /// Requests a stop, or replaces the cause of one, by what several processes agreed on.
    void agree_on(Cause cause) {
        cause_.store(cause, std::memory_order_relaxed);
        if (!interrupted()) interrupt(cause);
    }

    /// The cause of the stop; none if no stop is requested.
    Cause cause() const {
        const Cause given = cause_.load(std::memory_order_relaxed);
        return given == Cause::none && out_of_time() ? Cause::time_limit : given;
    }
    bool interrupted() const { return interrupted_at_.load(std::memory_order_acquire) != 0; }
    bool out_of_time() const { return Clock::now() >= deadline_; }
    /// Seconds until the deadline; infinite if there is none, negative after it has passed.
    double seconds_left() const {
        if (deadline_ == Clock::time_point::max()) return std::numeric_limits<double>::infinity();
        return std::chrono::duration<double>(deadline_ - Clock::now()).count();
    }
    bool requested() const { return interrupted() || out_of_time(); }
    /// Seconds since the stop was requested; 0 or negative if it was not. For work that must fit into the time that is
    /// left after a stop.
    double seconds_overdue() const {
        const Clock::time_point at{Clock::duration(interrupted_at_.load(std::memory_order_relaxed))};
        const double interrupt = interrupted() ? std::chrono::duration<double>(Clock::now() - at).count() : 0;
        return std::max(interrupt, -seconds_left());
    }

  private:
    std::atomic<Cause> cause_{Cause::none};
    std::atomic<Clock::rep> interrupted_at_{0};  ///< Clock time of the interrupt; 0: none.
    Clock::time_point deadline_ = Clock::time_point::max();
};

/// Measures the seconds since its construction or the last restart().
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
