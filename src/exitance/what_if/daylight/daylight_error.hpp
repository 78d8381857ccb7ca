#pragma once

#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/what_if/daylight/daylight_year.hpp"

namespace exitance {

/// A named range of consecutive sensors.
struct SensorGrid {
    std::string name;
    std::size_t count = 0;
};

/// Relative RMS errors over the sensors of a grid, of the mean over the grid; 0.01 is 1%.
struct DaylightError {
    double factor = 0;     ///< Error of the daylight factors.
    double lux_hours = 0;  ///< Error of the sums of the illuminances of all hours.
};

/// Parts of the error that the spread of the replicates does not show, measured at random sensors; relative to the mean
/// there.
struct DaylightBias {
    /// Difference to unbiased paths under the overcast sky: elements of reflected light, patches of the sky.
    double elements = 0;
    /// Difference of the light of random hours to that with the next finer patches, without straight sunlight.
    double patches = 0;
    std::size_t sensors = 0;  ///< Number of sensors at which these were measured.
};

/// Setting of one computation of a daylight matrix.
struct DaylightSetting {
    const Scene& scene;
    std::span<const ProbePoint> sensors;
    int division = 1;           ///< Parts into which Tregenza's patches are divided in each direction: 1, 2 or 4.
    const SkyPatches& patches;  ///< The patches of this division.
    std::span<const DaylightHour> hours;
    const DaylightSite& site;
    const YearSky& sky;  ///< Light of the hours in these patches.
    DaylightOptions options;
};

/// Measures the bias at up to 32 random sensors. `accuracy`: paths are traced until their standard error is a third of
/// this share of the mean.
DaylightBias measure_daylight_bias(const DaylightSetting& setting, const DaylightMatrix& matrix, double accuracy,
                                   Progress& progress, const StopRequest& stop);

/// Error of each grid: the standard error of the mean of the replicates, and the bias.
std::vector<DaylightError> daylight_errors(const DaylightSetting& setting, const DaylightMatrix& matrix,
                                           const DaylightBias& bias, std::span<const SensorGrid> grids);

}  // namespace exitance
