#pragma once

#include <string>

#include "exitance/io/report/daylight_tables.hpp"

namespace exitance {

/// Writes the illuminance of a year in the files of Honeybee's annual daylight results, which its tools for metrics and
/// maps read:
///
///     GRID.ill          a row per sensor, a column per hour with light: lx
///     sun-up-hours.txt  those hours: number of hours since the beginning of the year, at the middle of the hour
///     grids_info.json   names and numbers of sensors of the grids
///
/// The folder is created if necessary.
Result<void> write_honeybee_results(const std::string& folder, const DaylightTask& task,
                                    const DaylightResults& results);

}  // namespace exitance
