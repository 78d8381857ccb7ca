#pragma once

#include <string>

#include "exitance/core/result.hpp"
#include "exitance/methods/daylight/daylight_year.hpp"

namespace exitance {

/// Everything that a year's daylight comes to.
struct DaylightResults {
    std::vector<ProbePoint> sensors;
    std::vector<DaylightHour> hours;
    DaylightMatrix matrix;
    DaylightYear year;
    std::vector<DaylightMetrics> metrics;
    DaylightSummary summary;
};

/// Tables with a header, numbers between commas, in a folder that is made where it is missing:
///     illuminance.csv  month, day, hour, and a column a sensor: lx
///     sun.csv          the same of what comes straight from the sun
///     metrics.csv      a row a sensor: place, DF, DA, UDI, hours of sun
///     matrix.csv       a row a sensor, a column a patch of the sky: lx of 1 cd/m^2
///     summary.csv      name, value
Result<void> write_daylight(const std::string& folder, const DaylightResults& results);

/// What summary.csv holds.
std::vector<std::pair<std::string, double>> summary_values(const DaylightResults& results);

}  // namespace exitance
