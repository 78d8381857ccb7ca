#pragma once

#include <string_view>
#include <vector>

#include "exitance/cli/arguments.hpp"
#include "exitance/cli/exit_code.hpp"
#include "exitance/cli/progress_display.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// The program's way to its user: results go to standard output, everything else to the error stream; limits and
/// signals come in.
class Terminal {
  public:
    explicit Terminal(const CommonArguments& arguments);

    /// A result, to standard output; ends its last line if it does not end by itself.
    void print(std::string_view text);
    /// A remark, to the error stream; not with --quiet.
    void note(std::string_view text);
    /// "error: room.obj:41: face is 0.02 m out of plane", and a line with a hint.
    ExitCode fail(const Error& error);
    /// A run that a limit or a signal has stopped with no result: "error: --time-limit: 5 s have passed, and MESSAGE".
    ExitCode fail_stopped(const std::string& message);
    /// Warnings and repairs of a scene that can be used.
    void show(const std::vector<Finding>& findings);
    /// Why a scene cannot be used.
    ExitCode fail(const CheckedScene& checked);
    /// The same, with every error.
    ExitCode fail_with_all(const CheckedScene& checked);

    ProgressDisplay& progress() { return progress_; }
    RunLimits& limits() { return limits_; }

    /// Writes out what is buffered. A result that could not be written turns success into `no_result`.
    ExitCode finish(ExitCode code);

  private:
    bool quiet_;
    ProgressDisplay progress_;
    RunLimits limits_;
};

}  // namespace exitance
