#pragma once

#include <string>
#include <string_view>

#include "exitance/base/progress.hpp"
#include "exitance/cli/options/arguments.hpp"

namespace exitance {

/// Prints progress to stderr: the fraction of the current phase that is done, and an estimate of its remaining time.
class ProgressDisplay : public Progress {
  public:
    /// `style` must not be automatic. `verbose`: also prints notes, and a line with the time of every finished phase.
    ProgressDisplay(ProgressStyle style, bool quiet, bool verbose);

    void phase(std::string_view name) override;
    void advance(double fraction, std::string_view detail = {}) override;
    void note(std::string_view message) override;
    void warn(std::string_view message) override;

    /// Erases the bar, so that lines can be printed.
    void clear();
    /// Ends the current phase.
    void finish();

  private:
    void show(double fraction, std::string_view detail);
    void show_bar(double fraction, const std::string& words);

    ProgressStyle style_;
    bool quiet_, verbose_;
    std::string phase_;
    Stopwatch phase_time_, since_shown_;
    bool bar_is_up_ = false;
};

/// Replaces `automatic` by a bar if stderr is a terminal, else by plain lines. Other styles are returned unchanged.
ProgressStyle resolve(ProgressStyle style);

}  // namespace exitance
