#pragma once

#include <string>

#include "exitance/base/result.hpp"
#include "exitance/what_if/daylight/daylight_results.hpp"

namespace exitance {

/// Writes CSV tables to a folder, which is created if necessary:
///
///     illuminance.csv  month, day, hour, and one column per sensor: lx
///     sun.csv          the same for direct light of the sun
///     metrics.csv      one row per sensor: position, DF, DA, UDI, hours of sun, results for EN 17037, and the bounds
///     of
///                      these (_low, _high)
///     grids.csv        one row per grid: name, number of sensors, mean daylight factor, relative RMS errors
///     view.csv         one row per eye point: position, angle, distance, layers and level of the view (if requested)
///     matrix.csv       one row per sensor, one column per sky patch: lx for 1 cd/m^2
///     summary.csv      name, value
Result<void> write_daylight(const std::string& folder, const DaylightTask& task, const DaylightResults& results);

/// Names and values in summary.csv.
std::vector<std::pair<std::string, double>> summary_values(const DaylightTask& task, const DaylightResults& results);

}  // namespace exitance
