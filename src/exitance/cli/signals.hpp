#pragma once

#include <optional>

#include "exitance/base/progress.hpp"
#include "exitance/cli/exit_code.hpp"

namespace exitance {

/// Makes SIGINT and SIGTERM end the program at once with status 130 or 143, after removing unfinished files. Used while
/// an unfinished run has no result to keep.
void leave_at_signals();

/// During its lifetime SIGINT and SIGTERM request a stop, so that the work ends at its next safe point. A second signal
/// ends the program at once, as every signal does after its lifetime. Only one object may exist at a time.
class SignalGuard {
  public:
    explicit SignalGuard(StopRequest& stop);
    ~SignalGuard();
    SignalGuard(const SignalGuard&) = delete;
    SignalGuard& operator=(const SignalGuard&) = delete;

    /// The exit status for the signal received so far; none if there was no signal.
    std::optional<ExitCode> received() const;
};

}  // namespace exitance
