#pragma once

#include <string_view>
#include <vector>

#include "exitance/cli/arguments.hpp"
#include "exitance/cli/exit_code.hpp"
#include "exitance/cli/progress_display.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Where the program speaks: results on standard output, everything else on the error stream.
class Terminal {
  public:
    explicit Terminal(const CommonArguments& arguments);

    /// A result, to standard output; ends its last line if it does not end by itself.
    void print(std::string_view text);
    /// A remark, to the error stream; not with --quiet.
    void note(std::string_view text);
    /// "error: room.obj:41: face is 0.02 m out of plane", and a line with a hint.
    ExitCode fail(const Error& error);
    /// Warnings and repairs of a scene that can be used.
    void show(const std::vector<Finding>& findings);
    /// Why a scene cannot be used.
    ExitCode fail(const CheckedScene& checked);
    /// The same, with every error.
    ExitCode fail_with_all(const CheckedScene& checked);

    ProgressDisplay& progress() { return progress_; }

    /// Writes out what is buffered. A result that could not be written turns success into `no_result`.
    ExitCode finish(ExitCode code);

  private:
    bool quiet_;
    ProgressDisplay progress_;
};

}  // namespace exitance
