#include "exitance/methods/run_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/distinct_numbers.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/scene/findings.hpp"

namespace exitance {

void add_findings(std::vector<std::string>& warnings, std::span<const Finding> findings, const std::string& file) {
    std::vector<std::string> all;
    for (const Finding& finding : findings)
        if (finding.kind == Finding::Kind::warning)
            all.push_back(finding.file != file ? place_of(finding) + ": " + finding.message
                          : finding.line > 0   ? fmt::format("line {}: {}", finding.line, finding.message)
                                               : finding.message);
    warnings.insert(warnings.begin(), all.begin(), all.end());
}

void warn_of_useless_light(SolveStatistics& statistics) {
    const double error = statistics.relative_error_estimate.value_or(0);
    const bool is_useless = error >= 1;
    if (error < recognizable_error || (!is_useless && statistics.stopped_by == StopReason::divergence)) return;
    if (is_useless) statistics.converged = false;
    statistics.warnings.push_back(
        fmt::format("the estimated error is {:.0f}% of the light: the result is {}; refine the settings, or request an "
                    "--error",
                    100 * error, is_useless ? "not usable" : "a rough guess"));
}

namespace {

/// The reason why a solve ended early, and what to do; empty if there is nothing to say.
std::string reason_and_remedy(const SolveStatistics& statistics, const SolveOptions& options) {
    switch (statistics.stopped_by) {
        case StopReason::time_limit: {
            const auto next = statistics.figures.find(next_attempt_seconds);
            if (next == statistics.figures.end())
                return "the time limit ended the solve; allow more time, or request a larger --error";
            const double left = statistics.figures.at(seconds_left);
            constexpr double max_forecast = 1e6;  // s; derived from use: nobody waits for twelve days
            if (!(next->second < max_forecast))
                return fmt::format(
                    "another attempt would take far longer than the {:.3g} s that are left of the time limit; request "
                    "a larger --error",
                    left);
            const NumberTexts seconds = distinct_texts(next->second, left);
            return fmt::format(
                "another attempt would take about {} s, but {} s are left of the time limit; allow about {:.0f} s "
                "more, or request a larger --error",
                seconds.first, seconds.second, std::ceil(next->second - left));
        }
        case StopReason::memory_limit:
            return "the memory limit ended the solve; allow more memory, or request a larger --error";
        case StopReason::iterations:
            return form_of(options) == Form::standard
                       ? "all attempts were made; request a larger --error"
                       : "all attempts, or iterations of the method, were made; request a larger --error";
        case StopReason::unit_limit:
            return "all units are used; allow more by --max-units, or request a larger --error";
        case StopReason::interrupt:
            return "an interrupt ended the solve; run it again";
        case StopReason::termination:
            return "SIGTERM ended the solve; run it again";
        case StopReason::none:
        case StopReason::divergence:
            return {};
    }
    return {};
}

}  // namespace

std::optional<std::string> message_of_early_end(const SolveStatistics& statistics, const SolveOptions& options) {
    const std::optional<double> requested = options.error_demand();
    if (statistics.converged || !requested || !statistics.relative_error_estimate) return {};
    const std::string reason = reason_and_remedy(statistics, options);
    if (reason.empty()) return {};
    const double whole = *statistics.relative_error_estimate,
                 room = statistics.relative_error_estimate_worst_room.value_or(whole), error = std::max(whole, room);
    const std::string of_room = statistics.rooms.size() > 1 && room > whole
                                    ? fmt::format(" in the worst room, {:.3g}% in all", 100 * whole)
                                    : "";
    const NumberTexts percents = distinct_percents(error, *requested);
    const std::string found = fmt::format("the estimated error is {}%{}", percents.first, of_room);
    if (error > *requested) return fmt::format("{}, but {}% was requested: {}", found, percents.second, reason);
    return fmt::format("{}, but it is not certain that all rooms and bodies are within the requested {}%: {}", found,
                       percents.second, reason);
}

std::optional<Error> error_of_missing_estimate(const SolveStatistics& statistics, const SolveOptions& options,
                                               const std::string& where) {
    if (statistics.relative_error_estimate || !statistics.is_stopped() || !has_estimate(options)) return {};
    if (statistics.stopped_by == StopReason::interrupt || statistics.stopped_by == StopReason::termination)
        return Error{ErrorCode::limit, "the run was stopped before the first estimate of the error; nothing is written",
                     where, "run it again"};
    return Error{ErrorCode::limit,
                 fmt::format("the {} ended the run before the first estimate of the error; nothing is written",
                             name_of(statistics.stopped_by)),
                 where, "allow more time or memory, or request a larger --error"};
}

}  // namespace exitance
