#pragma once

#include <string>

#include "exitance/methods/plan/forecast.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// Summary of a solution as text: error, counts, energies, times and memory. `solve` and `stats` print it.
std::string summary(const Solution& solution);

/// Forecast of a solve as text, for `solve --dry-run`.
std::string summary(const Forecast& forecast);

/// Text of a share in percent, such as "6.25%" or "0.038%".
std::string percent(double share);

/// Text of a number of bytes, such as "1.2 GB" or "830 kB". Prefixes are powers of 1000.
std::string bytes(std::size_t count);

}  // namespace exitance
