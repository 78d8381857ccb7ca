#pragma once

#include <string>

#include "exitance/base/result.hpp"
#include "exitance/what_if/daylight/daylight_provision.hpp"
#include "exitance/what_if/daylight/view_out.hpp"

namespace exitance {

/// Everything that a year's daylight comes to.
struct DaylightResults {
    std::vector<ProbePoint> sensors;
    std::vector<DaylightHour> hours;
    DaylightMatrix matrix;
    DaylightYear year;
    std::vector<DaylightMetrics> metrics;
    DaylightSummary summary;
    DaylightProvision provision;
    std::vector<double> sunlight;  ///< Hours of it at each sensor on one cloudless day.
    std::vector<Point> eyes;       ///< Whose views out were asked for.
    std::vector<ViewOut> views;
};

/// Tables with a header, numbers between commas, in a folder that is made where it is missing:
///     illuminance.csv  month, day, hour, and a column a sensor: lx
///     sun.csv          the same of what comes straight from the sun
///     metrics.csv      a row a sensor: place, DF, DA, UDI, hours of sun, what EN 17037 asks for
///     view.csv         a row an eye: place, angle, distance, layers and level of the view out (where asked for)
///     matrix.csv       a row a sensor, a column a patch of the sky: lx of 1 cd/m^2
///     summary.csv      name, value
Result<void> write_daylight(const std::string& folder, const DaylightResults& results);

/// What summary.csv holds.
std::vector<std::pair<std::string, double>> summary_values(const DaylightResults& results);

}  // namespace exitance
