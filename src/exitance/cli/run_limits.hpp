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

namespace exitance {

/// Limits of a whole run.
struct LimitArguments {
    std::optional<double> time_limit;         ///< Seconds; none: no limit.
    std::optional<std::size_t> memory_limit;  ///< Resident memory of the process, bytes; none: no limit.
};

/// Enforces the limits of a run, and handles its signals.
///
/// A run begins with nothing to keep. A passed limit then ends the program with status 5, and a signal with 130 or 143;
/// both remove unfinished files. After keep(), limits and signals request a stop instead, and the verb writes what it
/// has. A thread watches the limits, so that they hold in code that checks no StopRequest. Without limits there is no
/// thread. Of several processes, only the first one ends the program.
class RunLimits {
  public:
    explicit RunLimits(const LimitArguments& limits);
    ~RunLimits();
    RunLimits(const RunLimits&) = delete;
    RunLimits& operator=(const RunLimits&) = delete;

    /// Requested once a limit is passed or, after keep(), a signal was received.
    StopRequest& stop() { return stop_; }
    enum class Signals { request_stop, end_program };
    /// From now on there is a result to keep. Returns stop().
    StopRequest& keep(Signals signals = Signals::request_stop);

    /// Seconds until the time limit; infinite without one, negative when it has passed.
    double seconds_left() const;
    /// The signal received since keep(); empty if none was.
    std::optional<ExitCode> signal() const { return signals_ ? signals_->received() : std::nullopt; }
    /// "interrupt", "memory limit" or "time limit": why stop() was requested.
    std::string reason() const;
    /// The error of a run that was stopped with no result.
    Error error(const std::string& message) const;
    /// Status of a run that was stopped and has written a result: the signal's, else 4.
    ExitCode stopped_code() const { return signal().value_or(ExitCode::demand_not_reached); }

  private:
    void watch();
    bool is_over_memory() const;
    [[noreturn]] void end_without_result() const;

    LimitArguments limits_;
    StopRequest::Clock::time_point end_ = StopRequest::Clock::time_point::max();  ///< Shortly after the time limit.
    StopRequest stop_;
    std::optional<SignalGuard> signals_;
    std::mutex mutex_;  ///< Guards the flags below.
    std::condition_variable changed_;
    bool keeps_ = false, is_over_ = false;
    std::atomic<bool> over_memory_{false};
    std::jthread watcher_;
};

/// The time point so many seconds from now, at most what the clock can hold.
StopRequest::Clock::time_point seconds_from_now(double seconds);

}  // namespace exitance
