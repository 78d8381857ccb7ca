#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exitance/progress.hpp"
#include "exitance/scene.hpp"
#include "exitance/solution.hpp"

namespace exitance::api {

/// Options of a solve, with the names, defaults and units of the command line.
struct SolveOptions {
    /// Requested relative RMS error of the light; none: 0.02, or no request if an option sets the accuracy by hand.
    std::optional<double> error = {};
    std::string method = "auto";                   ///< Method of the reflected light, as after --method.
    int bounces = -1;                              ///< Number of reflections; -1: all, 0: direct light alone.
    std::optional<double> time_limit = {};         ///< Seconds; the light found so far is returned.
    std::optional<std::size_t> memory_limit = {};  ///< Memory of the whole process, bytes.
    int threads = 0;                               ///< 0: as set_threads() says. The light does not depend on it.
    /// Further options of `exitance solve`, by name without "--", and the words after them (empty for flags):
    /// {"mesh-size", "0.1"}. Options of files, of published forms and of the laboratory are refused.
    std::vector<std::pair<std::string, std::string>> more = {};
};

/// Computes the light of a scene until its estimated error is below the requested one. A missed error is not a failure:
/// see Solution::converged.
/// Errors: usage for options that are wrong or do not fit together; limit if a stop or a limit left no light with an
/// error estimate. Same bits on any number of threads.
Result<Solution> solve(const Scene& scene, const SolveOptions& options = {}, const Control& control = {});

}  // namespace exitance::api
