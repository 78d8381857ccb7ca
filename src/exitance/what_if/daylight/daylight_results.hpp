#pragma once

#include "exitance/what_if/daylight/daylight_intervals.hpp"
#include "exitance/what_if/daylight/view_out.hpp"

namespace exitance {

/// Results of a daylight simulation over a year.
struct DaylightResults {
    std::vector<ProbePoint> sensors;
    std::vector<SensorGrid> grids;  ///< Together all sensors, in their order.
    std::vector<DaylightHour> hours;
    DaylightMatrix matrix;
    DaylightBias bias;
    std::vector<DaylightError> errors;  ///< One per grid.
    DaylightYear year;
    std::vector<DaylightMetrics> metrics;
    DaylightIntervals intervals;
    DaylightSummary summary;
    DaylightProvision provision;
    std::vector<double> sunlight;  ///< Hours of direct sunlight at each sensor on a cloudless day.
    std::vector<Point> eyes;       ///< Eye points whose views out were requested.
    std::vector<ViewOut> views;

    /// The largest errors of a grid.
    DaylightError worst_error() const {
        DaylightError out;
        for (const DaylightError& e : errors)
            out = {std::max(out.factor, e.factor), std::max(out.lux_hours, e.lux_hours)};
        return out;
    }
};

/// Computes the matrix, with as many rays and elements as the requested error of every grid needs, then the year, its
/// metrics and their intervals. `results`: sensors, grids and hours are given, the rest is computed, except sunlight
/// and views. `error`: for every grid, of the daylight factors and of the lux hours. After 7 computations of the
/// matrix, each with four times the rays or elements, the last counts. Error: ErrorCode::limit after a stop request.
Result<void> simulate_year(const Scene& scene, int division, const DaylightSite& site, double error,
                           DaylightResults& results, Progress& progress, const StopRequest& stop);

}  // namespace exitance
