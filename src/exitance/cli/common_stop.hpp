#pragma once

#include <optional>
#include <string>

#include "exitance/base/progress.hpp"
#include "exitance/cli/terminal.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {

/// The stop request of a verb that may run over several processes: a limit or a signal of any process stops all of
/// them, at the end of the shared loop that they are in. With one process it is the request of its RunLimits. Only one
/// object may exist at a time.
class CommonStop {
  public:
    /// How the memory limit is kept with several processes.
    enum class MemoryLimit {
        watched,  ///< The work is stopped when it exceeds the limit.
        fitted,   ///< The work fits itself into the limit.
    };
    /// `asked`: the request of the terminal's limits, from RunLimits::keep(), or from stop() without a result to keep.
    CommonStop(Terminal& terminal, StopRequest& asked, MemoryLimit memory = MemoryLimit::watched);

    /// Returns the request that long work must check.
    const StopRequest& request() const { return processes() > 1 ? agreed_ : asked_; }
    /// Sets a deadline for this work, which is no later than the time limit.
    void set_deadline(StopRequest::Clock::time_point deadline) { asked_.set_deadline(deadline); }

    /// The signal that any process has received, as the exit status for it; none if there was no signal. Collective.
    std::optional<ExitCode> signal() const;
    /// The reason of the stop, as RunLimits::reason(). Collective.
    StopReason reason() const;
    /// Exit status of a run that was stopped and has written a result: that of the signal, else 4. Collective.
    ExitCode stopped_code() const { return signal().value_or(ExitCode::demand_not_reached); }
    /// Reports that a run was stopped without a result, unless by a signal; `message` ends its sentence. Returns the
    /// exit status. Collective.
    ExitCode fail(const std::string& message) const;

  private:
    Terminal& terminal_;
    StopRequest agreed_;
    StopRequest& asked_;
    StopTogether together_;
};

}  // namespace exitance
