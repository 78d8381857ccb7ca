#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exitance/scene/scene.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

// Facts about a whole run, from reading the scene to the solution, that its statistics record.

/// Prepends the warnings among the findings, with their places, so that the solution records them. `file`: the scene's
/// file, which is not repeated in front of its findings.
void add_findings(std::vector<std::string>& warnings, std::span<const Finding> findings, const std::string& file);

/// Adds a warning if the error is above a third of the light, which can happen if no error was requested. A result
/// whose error is as large as the light has not converged.
void warn_of_useless_light(SolveStatistics& statistics);

/// Keys of SolveStatistics::figures that are set if the time left was too short for another attempt: its expected
/// duration and the time left, s.
inline constexpr const char* next_attempt_seconds = "next_attempt_seconds";
inline constexpr const char* seconds_left = "seconds_left";

/// Returns a message about a solve that ended before it reached the requested error: the error, the limit or other
/// reason that ended it, and what to do. None if it reached the error, if none was requested or estimated, or if it
/// diverged, which has a warning of its own.
std::optional<std::string> message_of_early_end(const SolveStatistics& statistics, const SolveOptions& options);

/// Returns the failure of a run that a stop ended before there was light with an estimate of its error; else none.
/// Light of forms that never estimate their error is delivered in any case. `where`: the output, or empty.
std::optional<Error> error_of_missing_estimate(const SolveStatistics& statistics, const SolveOptions& options,
                                               const std::string& where);

}  // namespace exitance
