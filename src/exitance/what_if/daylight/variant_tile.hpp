#pragma once

#include <span>
#include <vector>

#include "exitance/what_if/daylight/daylight_states.hpp"
#include "exitance/what_if/daylight/spread_result.hpp"

namespace exitance {

/// Results of a year at a sensor with other glass.
struct VariantResult {
    SpreadResult autonomy;   ///< DA
    double continuous = 0;   ///< Continuous DA.
    double illuminance = 0;  ///< Mean over the occupied hours, lx.
    double sunny_hours = 0;  ///< Occupied hours with more than 1000 lx of direct sunlight.
};

/// Evaluates the variants of HourlyStates at the sensors of a tile. All arrays have a row per sensor and a column per
/// hour.
class VariantTile {
  public:
    /// `states`: contains the variants. Both references must outlive this object. `bias`: relative error, as for
    /// SensorYears.
    VariantTile(const HourlyStates& states, const DaylightCriteria& criteria, double bias, std::size_t sensors);

    /// Adds an estimate of the light: `lux` in the first states, and its parts. `replicate`: its number, or the number
    /// of replicates for their mean.
    void add(std::size_t replicate, std::span<const float> lux, std::span<const std::vector<float>> parts);
    /// Adds the direct sunlight in the first states, and its parts.
    void add_sun(std::span<const float> sun, std::span<const std::vector<float>> parts);

    /// Returns the results: sensor by sensor, a value per variant.
    const std::vector<VariantResult>& results() const { return results_; }

  private:
    std::span<const float> combined(std::size_t variant);
    void pick_occupied(std::size_t sensor, std::span<const float> lux, std::span<const std::vector<float>> parts);
    void add_mean(std::span<const float> lux, const VariantWeights& weights, VariantResult& out) const;

    const HourlyStates& states_;
    const DaylightCriteria& criteria_;
    double bias_;
    std::vector<VariantResult> results_;
    std::vector<float> all_, sum_;            ///< Occupied hours of one sensor: light, and that of a variant.
    std::vector<std::vector<float>> picked_;  ///< Occupied hours of one sensor, per part.
};

/// Results of all sensors with other glass.
struct VariantSummary {
    double autonomy = 0;     ///< sDA(target, 50%): share of sensors.
    Interval bounds;         ///< 95% confidence interval of `autonomy`.
    double exposure = 0;     ///< ASE(1000 lx, 250 h): share of sensors.
    double continuous = 0;   ///< Mean of the sensors.
    double illuminance = 0;  ///< Mean of the sensors and occupied hours, lx.
};

/// Collects the results of variants. O(1) memory per variant.
class VariantTotals {
  public:
    explicit VariantTotals(std::size_t variants) : sums_(variants), reached_(variants) {}
    /// Adds the variants of one sensor.
    void add(std::span<const VariantResult> sensor);
    std::vector<VariantSummary> summaries() const;

  private:
    std::size_t sensors_ = 0;
    std::vector<VariantSummary> sums_;
    std::vector<SpreadResult> reached_;  ///< Number of sensors with DA of at least one half.
};

}  // namespace exitance
