#pragma once

#include <optional>

#include "exitance/base/progress.hpp"
#include "exitance/cli/exit_code.hpp"

namespace exitance {

/// From now on SIGINT and SIGTERM end the program at once, with the exit status for them; files that are not whole yet
/// are removed. For all work that leaves nothing unless it is done.
void leave_at_signals();

/// While it lives, SIGINT and SIGTERM ask the work to stop at its next safe point; a second one ends the program at
/// once, and so does the first one when it is gone. One at a time.
class SignalGuard {
  public:
    explicit SignalGuard(StopRequest& stop);
    ~SignalGuard();
    SignalGuard(const SignalGuard&) = delete;
    SignalGuard& operator=(const SignalGuard&) = delete;

    /// The exit status that the signal received so far asks for; empty when there was none.
    std::optional<ExitCode> received() const;
};

}  // namespace exitance
