#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "exitance/base/progress.hpp"
#include "exitance/cli/arguments.hpp"

namespace exitance {

/// Shows on the error stream how far the work is and about how long its present phase will still take.
class ProgressDisplay : public Progress {
  public:
    /// `style` must not be automatic. Verbose: every finished phase leaves a line with its time.
    ProgressDisplay(ProgressStyle style, bool quiet, bool verbose);

    void phase(std::string_view name) override;
    void advance(double fraction, std::string_view detail = {}) override;
    void note(std::string_view message) override;
    void warn(std::string_view message) override;

    /// Takes the bar off the screen, so that lines may follow.
    void clear();
    /// The last phase is over.
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

/// The style that `automatic` stands for: a bar if the error stream is a terminal, else plain lines.
ProgressStyle resolve(ProgressStyle style);

}  // namespace exitance
