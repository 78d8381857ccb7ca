#pragma once

#include <map>

#include "exitance/what_if/daylight/daylight_error.hpp"
#include "exitance/what_if/daylight/daylight_states.hpp"

namespace exitance {

/// Setting of the computation of a year.
struct DaylightSetting {
    const Scene& scene;
    std::span<const ProbePoint> sensors;
    std::span<const SensorGrid> grids;  ///< Grids that together contain all sensors, in their order.
    const SkyPatches& patches;
    const SkyPatches* finer;  ///< The next finer patches; null if there are none.
    std::span<const DaylightHour> hours;
    const DaylightSite& site;
    const YearSky& sky;  ///< Light of the hours in the patches.
    const DaylightCriteria& criteria;
    std::uint64_t seed = 1;
    const HourlyStates* states = nullptr;  ///< States of panes in every hour; null if they do not change.
};

/// Random sensors of every grid, at which a search measures the errors of a daylight matrix without computing it: their
/// results need one right-hand side each.
class DaylightSample {
  public:
    /// Chooses up to 256 sensors of every grid, fewer if there are more than 8 grids, and finds the light that they
    /// receive straight from the sky.
    DaylightSample(const DaylightSetting& setting, const DaylightTransport& transport);

    /// Forgets all rays, for a transport with new elements.
    void forget_rays();
    /// Casts rays until every sensor has `rays`, and evaluates the results with the rays of the transport.
    void evaluate(const DaylightTransport& transport, unsigned rays);

    /// Errors of every grid, estimated at its random sensors.
    std::vector<DaylightError> errors(const DaylightBias& bias) const;

    /// Measures the bias at up to 32 of the sensors. `error`: paths are traced until the bias plus its standard error
    /// is below half of this, or until their standard error is a third of it, relative to the mean.
    DaylightBias measure_bias(double error, Progress& progress, const StopRequest& stop) const;

    /// Returns the RMS over the sample of the light of the overcast sky that has crossed panes of groups at least
    /// twice, relative to the mean light. Needs the rays of evaluate().
    double measure_twice(const DaylightTransport& transport) const;

    /// Returns the rays of a sensor of the sample, and its direct light; null for other sensors.
    const KnownSensor* find(std::size_t number) const;

  private:
    struct Sensor {
        std::size_t number = 0, grid = 0;
        SurfacePoint at;
        KnownSensor known;
        LinearResults results;
        std::vector<float> direct_finer;        ///< Irradiance by finer patches; empty unless the bias is measured.
        Replicates patches{}, finer_patches{};  ///< Light of the random hours, lx h.
    };
    void choose_sensors(const DaylightTransport& transport);
    void find_direct(const DaylightTransport& transport);
    SkyColumns columns() const;
    void evaluate(Sensor& sensor, const ElementLight& light) const;
    double bias_of_elements(double error, Progress& progress, const StopRequest& stop) const;
    double bias_of_patches() const;

    const DaylightSetting& setting_;
    std::vector<double> overcast_;
    std::vector<DaylightHour> random_hours_;
    std::unique_ptr<YearSky> sky_, finer_sky_;  ///< Light of the random hours.
    std::vector<Sensor> sensors_;
    std::vector<std::size_t> for_bias_;  ///< Indices of the sensors at which the bias is measured.
    std::map<std::size_t, std::size_t> index_;
};

}  // namespace exitance
