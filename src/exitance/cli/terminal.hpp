#pragma once

#include <string_view>
#include <vector>

#include "exitance/cli/exit_code.hpp"
#include "exitance/cli/options/arguments.hpp"
#include "exitance/cli/progress_display.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Output of a verb: results to standard output, everything else to stderr. Also holds its progress display and its
/// limits. With several processes only the first one prints.
class Terminal {
  public:
    explicit Terminal(const CommonArguments& arguments);

    /// Prints a result to standard output and adds a missing line end.
    void print(std::string_view text);
    /// Prints a line to stderr, except with --quiet.
    void note(std::string_view text);
    /// Prints an error, such as "error: room.obj:41: face is 0.02 m out of plane", and a line with its hint. Returns
    /// its exit code.
    ExitCode fail(const Error& error);
    /// Ends a run that was stopped without a result. Returns the signal's exit code, or prints for a limit "error:
    /// --time-limit: 5 s have passed, and MESSAGE" and returns that of the error.
    ExitCode fail_stopped(const std::string& message);
    /// Prints the warnings and repairs of a scene, at most 20 of them.
    void show(const std::vector<Finding>& findings);
    /// Prints the first error of a scene that cannot be used. Returns its exit code.
    ExitCode fail(const CheckedScene& checked);
    /// Like fail(checked), with every error of the scene.
    ExitCode fail_with_all(const CheckedScene& checked);

    ProgressDisplay& progress() { return progress_; }
    RunLimits& limits() { return limits_; }

    /// Flushes standard output. Returns `code`, or `no_result` if it is `done` and the output could not be written.
    ExitCode finish(ExitCode code);

  private:
    bool quiet_;
    ProgressDisplay progress_;
    RunLimits limits_;
};

}  // namespace exitance
