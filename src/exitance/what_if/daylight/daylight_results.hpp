#pragma once

#include <functional>

#include "exitance/what_if/daylight/daylight_search.hpp"
#include "exitance/what_if/daylight/daylight_totals.hpp"
#include "exitance/what_if/daylight/view_out.hpp"

namespace exitance {

/// A daylight simulation over a year: what to compute.
struct DaylightTask {
    std::vector<ProbePoint> sensors;
    std::vector<SensorGrid> grids;  ///< Together all sensors, in their order.
    std::vector<DaylightHour> hours;
    DaylightSite site;
    int division = 1;               ///< Parts into which Tregenza's patches are divided in each direction: 1, 2 or 4.
    double error = 0.02;            ///< Requested error of every grid.
    std::optional<SunDay> sun_day;  ///< Day for which hours of sunlight are counted.
};

/// Receives the results of consecutive sensors, in order. An error ends the simulation.
using DaylightSink = std::function<Result<void>(const DaylightBlock&)>;

/// Finds the light on the elements for the requested error, and evaluates the year at all sensors, block by block.
/// Memory is that of the elements, of at most 2048 random sensors and of one block of sensors.
/// Error: ErrorCode::limit after a stop request, or the error of the sink.
Result<DaylightSummary> simulate_year(const Scene& scene, const DaylightTask& task, const DaylightSink& sink,
                                      Progress& progress, const StopRequest& stop);

/// Illuminances of a year.
struct DaylightYear {
    std::size_t sensors = 0;
    std::vector<float> illuminance;  ///< lx; one row per hour, one column per sensor.
    std::vector<float> sun;          ///< Direct sunlight contained in `illuminance`, lx.
};

/// All results of a simulation in memory.
struct DaylightResults {
    DaylightMatrix matrix;
    DaylightYear year;
    std::vector<SensorResults> sensors;
    DaylightSummary summary;
    std::vector<Point> eyes;  ///< Eye points whose views out were requested.
    std::vector<ViewOut> views;
};

/// Runs simulate_year() and keeps all results. About 75 kB per sensor.
Result<DaylightResults> collect_year(const Scene& scene, const DaylightTask& task, Progress& progress,
                                     const StopRequest& stop);

}  // namespace exitance
