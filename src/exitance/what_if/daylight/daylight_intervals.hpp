#pragma once

#include "exitance/what_if/daylight/daylight_error.hpp"
#include "exitance/what_if/daylight/daylight_provision.hpp"

namespace exitance {

/// Bounds of a result.
struct Interval {
    double low = 0, high = 0;
};

/// Bounds of the results of one sensor.
struct SensorIntervals {
    Interval factor;                 ///< Daylight factor, per cent.
    Interval autonomy;               ///< DA(300 lx)
    std::array<Interval, 4> useful;  ///< UDI
    Interval reached;                ///< Illuminance reached in half of the daylight hours, lx.
};

/// Bounds of the results of a year.
struct DaylightIntervals {
    std::vector<SensorIntervals> sensors;
    Interval mean_factor;       ///< Mean daylight factor, per cent.
    Interval spatial_autonomy;  ///< sDA(300 lx, 50%)
};

/// 95% intervals: Student's for the mean of the replicates, each of which gives every result anew (an hour's noise is
/// that of the sensor's coefficients, which all hours share), widened to the results with all light larger and smaller
/// by the bias. Direct sunlight is exact. O(replicates x sensors x hours x patches).
DaylightIntervals daylight_intervals(const DaylightSetting& setting, const DaylightMatrix& matrix,
                                     const DaylightYear& year, const DaylightBias& bias);

}  // namespace exitance
