#pragma once

#include <string>

#include "exitance/methods/plan/forecast.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// What a solve took and what it reached, for people: what `solve` and `stats` print.
std::string summary(const Solution& solution);

/// What `solve --dry-run` prints.
std::string summary(const Forecast& forecast);

/// "6.25%", "0.038%".
std::string percent(double share);

/// "1.2 GB", "830 kB".
std::string bytes(std::size_t count);

}  // namespace exitance
