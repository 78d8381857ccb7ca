#include "exitance/cli/terminal.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "exitance/processes/distributed.hpp"
#include "exitance/scene/findings.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_findings = 20;  ///< Limit on the findings that show() prints.

}  // namespace

Terminal::Terminal(const CommonArguments& arguments)
    : quiet_(arguments.quiet || !is_first_process()),
      progress_(is_first_process() ? resolve(arguments.progress) : ProgressStyle::none, quiet_, arguments.verbose),
      limits_(arguments.limits) {}

void Terminal::print(std::string_view text) {
    progress_.clear();
    if (is_first_process()) fmt::print(stdout, "{}{}", text, text.ends_with('\n') ? "" : "\n");
}

void Terminal::note(std::string_view text) {
    progress_.clear();
    if (!quiet_) fmt::print(stderr, "{}\n", text);
}

ExitCode Terminal::fail(const Error& error) {
    progress_.clear();
    if (!is_first_process()) return exit_code(error.code);
    fmt::print(stderr, "error: {}{}{}\n", error.where, error.where.empty() ? "" : ": ", error.message);
    if (!error.hint.empty()) fmt::print(stderr, "hint: {}\n", error.hint);
    return exit_code(error.code);
}

ExitCode Terminal::fail_stopped(const std::string& message) {
    if (const std::optional<ExitCode> signal = limits_.signal()) return *signal;
    return fail(limits_.error(message));
}

void Terminal::show(const std::vector<Finding>& findings) {
    progress_.clear();
    if (quiet_) return;
    std::size_t shown = 0;
    for (const Finding& finding : findings) {
        if (finding.kind == Finding::Kind::error) continue;
        if (++shown > max_findings) continue;
        fmt::print(stderr, "{}: {}: {}\n", finding.kind == Finding::Kind::repair ? "repair" : "warning",
                   place_of(finding), finding.message);
    }
    if (shown > max_findings)
        fmt::print(stderr, "warning: {} more findings; `exitance check` shows them all\n", shown - max_findings);
}

ExitCode Terminal::fail(const CheckedScene& checked) {
    // The message of the first error gives the number of further errors.
    const ExitCode code = fail(checked.scene.error());
    std::size_t errors = 0;
    for (const Finding& finding : checked.findings) errors += finding.kind == Finding::Kind::error;
    if (errors > 1) note("`exitance check` shows them all");
    return code;
}

ExitCode Terminal::fail_with_all(const CheckedScene& checked) {
    for (const Finding& finding : checked.findings)
        if (finding.kind == Finding::Kind::error)
            fail(Error{ErrorCode::bad_input, finding.message, place_of(finding), finding.hint});
    return exit_code(checked.scene.error().code);
}

ExitCode Terminal::finish(ExitCode code) {
    progress_.finish();
    const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
    if (written || code != ExitCode::done) return code;
    return fail(Error{ErrorCode::cannot_write, "the result could not be written", "standard output",
                      "check the space on the disk, and whether the reading program still runs"});
}

}  // namespace exitance
