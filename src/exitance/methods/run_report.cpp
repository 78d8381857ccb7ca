#include "exitance/methods/run_report.hpp"

#include <fmt/format.h>

#include "exitance/calibration/error_budget.hpp"
#include "exitance/methods/methods.hpp"
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

std::optional<Error> error_of_missing_estimate(const SolveStatistics& statistics, const SolveOptions& options,
                                               const std::string& where) {
    if (statistics.relative_error_estimate || !statistics.is_stopped() || !has_estimate(options)) return {};
    if (statistics.stopped_by == StopReason::interrupt)
        return Error{ErrorCode::limit, "the run was stopped before the first estimate of the error; nothing is written",
                     where, "run it again"};
    return Error{ErrorCode::limit,
                 fmt::format("the {} ended the run before the first estimate of the error; nothing is written",
                             name_of(statistics.stopped_by)),
                 where, "allow more time or memory, or request a larger --error"};
}

}  // namespace exitance
