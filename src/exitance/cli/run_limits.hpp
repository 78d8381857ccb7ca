#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/cli/exit_code.hpp"
#include "exitance/cli/signals.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// Limits on a whole run.
struct LimitArguments {
    std::optional<double> time_limit;         ///< Seconds; none: no limit.
    std::optional<std::size_t> memory_limit;  ///< Resident memory of the process, bytes; none: no limit.
};

/// Enforces the limits of a run, and handles its signals.
///
/// Before keep() is called, there is no result: an exceeded limit ends the program with status 5, and a signal with 130
/// or 143; both remove unfinished files. After keep(), limits and signals request a stop instead, and the verb writes
/// its result so far. A thread watches the limits, so that they hold in code that checks no StopRequest. Without limits
/// there is no thread. With several processes, only the first one ends the program, and the memory limit is watched
/// only after watch_memory_of_several().
class RunLimits {
  public:
    explicit RunLimits(const LimitArguments& limits);
    ~RunLimits();
    RunLimits(const RunLimits&) = delete;
    RunLimits& operator=(const RunLimits&) = delete;

    /// The stop request of the run. It is made when a limit is exceeded or, after keep(), a signal is received.
    StopRequest& stop() { return stop_; }
    /// Effect of signals after keep().
    enum class Signals { request_stop, end_program };
    /// Declares that from now on there is a result to keep. Returns stop().
    StopRequest& keep(Signals signals = Signals::request_stop);

    /// Watches the memory limit with several processes as well: each may use it, and a page that n processes of a node
    /// share counts 1/n.
    void watch_memory_of_several();

    /// Seconds until the time limit; infinite without a limit, negative after it.
    double seconds_left() const;
    /// The signal received since keep(); empty if none was.
    std::optional<ExitCode> signal() const { return signals_ ? signals_->received() : std::nullopt; }
    /// The reason why stop() was requested: a signal or a limit.
    StopReason reason() const;
    /// The error of a run that a limit stopped without a result. `message` ends its sentence.
    Error error(const std::string& message) const;
    /// Exit status of a run that was stopped and has written a result: that of the signal, else 4.
    ExitCode stopped_code() const { return signal().value_or(ExitCode::demand_not_reached); }

  private:
    void watch();
    std::size_t used_memory_bytes() const;
    bool is_over_memory() const;
    [[noreturn]] void end_without_result() const;

    LimitArguments limits_;
    const bool is_alone_, is_first_;  ///< True if there is one process; if this is the first one.
    StopRequest::Clock::time_point end_ =
        StopRequest::Clock::time_point::max();  ///< Time limit plus a grace period of 0.2 s.
    StopRequest stop_;
    std::optional<SignalGuard> signals_;
    std::mutex mutex_;  ///< Guards the flags below.
    std::condition_variable changed_;
    bool keeps_ = false, is_over_ = false, watches_several_ = false;
    std::atomic<bool> over_memory_{false};
    std::jthread watcher_;
};

/// The time point `seconds` from now. Seconds are limited to 1e9, which the clock can represent.
StopRequest::Clock::time_point seconds_from_now(double seconds);

}  // namespace exitance
