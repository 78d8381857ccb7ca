#pragma once

#include "exitance/what_if/daylight/sensor_year.hpp"

namespace exitance {

/// Protection from glare by EN 17037 at the views of a year.
struct GlareSummary {
    std::size_t views = 0;
    std::array<double, 3> at_level{};  ///< Shares of the views that reach the levels minimum, medium and high.
    int level = 0;                     ///< Highest level that all views reach.
    double worst = 0;                  ///< Largest DGP of a view that 5% of the occupied hours exceed.
};

/// Reasons for which sDA and ASE are not those of LM-83, as sentences; empty: they conform.
struct Lm83Deviations {
    std::vector<std::string> autonomy, exposure;
};

/// Results of all sensors of a year together, with equal weights.
struct DaylightSummary {
    std::size_t sensors = 0;
    double mean_daylight_factor = 0;  ///< Per cent.
    double spatial_autonomy = 0;      ///< sDA(target, 50%): share of sensors.
    double sunlight_exposure = 0;     ///< ASE(1000 lx, 250 h): share of sensors.
    std::size_t occupied_hours = 0;
    double continuous_autonomy = 0;    ///< Mean of the sensors.
    double electric_hours = 0;         ///< Hours at full power of dimmed electric light, mean of the sensors.
    Interval mean_factor;              ///< 95% interval of the mean daylight factor, per cent.
    Interval spatial_autonomy_bounds;  ///< 95% interval of sDA.
    double max_sunlight = 0;           ///< Largest number of hours of sunlight on the cloudless day.
    DaylightProvision provision;
    DaylightBias bias;
    std::vector<DaylightError> errors;  ///< Errors of each grid.
    std::vector<double> grid_factors;   ///< Mean daylight factor of every grid, per cent.
    std::optional<GlareSummary> glare;  ///< Glare; none if there are no views.
    Lm83Deviations lm83;
};

/// Collects the results of sensors, in their order. O(1) memory per grid.
class DaylightTotals {
  public:
    DaylightTotals(std::span<const SensorGrid> grids, std::span<const DaylightHour> hours, const DaylightSite& site,
                   const DaylightCriteria& criteria);

    void add(const SensorResults& sensor);
    DaylightSummary summary(const DaylightBias& bias) const;

  private:
    std::vector<std::size_t> ends_;  ///< Number of the sensor after the last of every grid.
    std::vector<GridErrorSum> grids_;
    std::size_t grid_ = 0;           ///< Grid of the next sensor.
    DaylightSummary sums_;           ///< Sums and counts of sensors.
    SpreadResult factor_, reached_;  ///< Sum of the daylight factors; number of sensors with DA of at least one half.
    ProvisionCount provision_;
};

}  // namespace exitance
