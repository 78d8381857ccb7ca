#pragma once

#include <string>

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

    double largest() const { return std::max(factor, lux_hours); }
};

/// Returns the largest errors of a grid; not a number if an error is not known.
DaylightError worst_of(std::span<const DaylightError> errors);

/// Parts of the error that the spread of the replicates does not show, measured at random sensors; relative to the mean
/// there.
struct DaylightBias {
    /// Difference to unbiased paths under the overcast sky: elements of reflected light, patches of the sky.
    double elements = 0;
    /// Difference of the light of random hours to that with the next finer patches, without straight sunlight.
    double patches = 0;
    std::size_t sensors = 0;  ///< Number of sensors at which both were measured.

    double total() const { return std::hypot(elements, patches); }
};

/// A result of each replicate.
using Replicates = std::array<double, daylight_replicates>;

/// Mean of the replicates, and variance of this mean.
struct ReplicateMean {
    double mean = 0, variance = 0;
};
ReplicateMean mean_of(const Replicates& values);

/// Results of a sensor that are linear in its coefficients, and for which errors are estimated.
struct LinearResults {
    Replicates factor{};     ///< Daylight factor, per cent.
    Replicates lux_hours{};  ///< Light of all hours, lx h, without straight sunlight.
};

/// Collects the errors of a grid from its sensors.
class GridErrorSum {
  public:
    void add(const LinearResults& sensor);
    /// Standard error of the mean of the replicates, RMS over the sensors, and the bias.
    DaylightError error(const DaylightBias& bias) const;
    double mean_factor() const { return count_ > 0 ? factor_.mean / static_cast<double>(count_) : 0; }

  private:
    std::size_t count_ = 0;
    ReplicateMean factor_, lux_hours_;  ///< Sums over the sensors.
};

}  // namespace exitance
