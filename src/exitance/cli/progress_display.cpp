#include "exitance/cli/progress_display.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <optional>

#include "exitance/cli/json_output.hpp"

namespace exitance {
namespace {

/// Remaining seconds of a phase, extrapolated from its speed so far; none before 1% or half a second.
std::optional<double> remaining(double fraction, double elapsed) {
    if (fraction < 0.01 || elapsed < 0.5) return std::nullopt;
    return elapsed * (1 - fraction) / fraction;
}

std::string duration(double seconds) {
    if (seconds < 100) return fmt::format("{:.0f} s", seconds);
    const auto minutes = static_cast<long>(seconds / 60);
    if (minutes < 100) return fmt::format("{} min", minutes);
    return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

int terminal_columns() {
    winsize size{};
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

ProgressStyle resolve(ProgressStyle style) {
    if (style != ProgressStyle::automatic) return style;
    return isatty(STDERR_FILENO) ? ProgressStyle::bar : ProgressStyle::plain;
}

ProgressDisplay::ProgressDisplay(ProgressStyle style, bool quiet, bool verbose)
    : style_(quiet && style != ProgressStyle::json ? ProgressStyle::none : style), quiet_(quiet), verbose_(verbose) {}

void ProgressDisplay::phase(std::string_view name) {
    finish();
    phase_ = name;
    phase_time_.restart();
    if (style_ == ProgressStyle::json) show(0, {});
}

void ProgressDisplay::advance(double fraction, std::string_view detail) {
    const double interval = style_ == ProgressStyle::bar ? 0.1 : style_ == ProgressStyle::json ? 1 : 10;
    if (style_ == ProgressStyle::none || since_shown_.seconds() < interval) return;
    show(std::clamp(fraction, 0.0, 1.0), detail);
}

void ProgressDisplay::show(double fraction, std::string_view detail) {
    const double elapsed = phase_time_.seconds();
    const std::optional<double> left = remaining(fraction, elapsed);
    since_shown_.restart();
    if (style_ == ProgressStyle::json) {
        fmt::print(stderr, "{}\n", progress_json(phase_, fraction, detail, elapsed, left));
        return;
    }
    std::string words(detail);
    if (left) words += fmt::format("{}about {} left", words.empty() ? "" : ", ", duration(*left));
    if (style_ == ProgressStyle::bar) {
        show_bar(fraction, words);
    } else {
        fmt::print(stderr, "{} {:.0f}%{}{}\n", phase_, 100 * fraction, words.empty() ? "" : "  ", words);
    }
}

void ProgressDisplay::show_bar(double fraction, const std::string& words) {
    constexpr int width = 24;
    const int full = static_cast<int>(fraction * width + 0.5);
    std::string line = fmt::format("{:<11} [{}{}] {:3.0f}%  {}", phase_, std::string(full, '#'),
                                   std::string(width - full, '-'), 100 * fraction, words);
    line.resize(std::min<std::size_t>(line.size(), static_cast<std::size_t>(terminal_columns() - 1)));
    fmt::print(stderr, "\r\033[K{}", line);
    std::fflush(stderr);
    bar_is_up_ = true;
}

void ProgressDisplay::note(std::string_view message) {
    if (!verbose_ || quiet_) return;
    clear();
    fmt::print(stderr, "{}\n", message);
}

void ProgressDisplay::warn(std::string_view message) {
    clear();
    if (!quiet_) fmt::print(stderr, "warning: {}\n", message);
}

void ProgressDisplay::clear() {
    if (bar_is_up_) fmt::print(stderr, "\r\033[K");
    bar_is_up_ = false;
}

void ProgressDisplay::finish() {
    clear();
    if (phase_.empty()) return;
    if (style_ == ProgressStyle::json) show(1, {});
    if (verbose_ && !quiet_ && style_ != ProgressStyle::json)
        fmt::print(stderr, "{} took {:.2f} s\n", phase_, phase_time_.seconds());
    phase_.clear();
}

}  // namespace exitance
