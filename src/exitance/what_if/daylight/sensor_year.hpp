#pragma once

#include <optional>

#include "exitance/what_if/daylight/daylight_provision.hpp"
#include "exitance/what_if/daylight/daylight_sample.hpp"
#include "exitance/what_if/daylight/spread_result.hpp"
#include "exitance/what_if/daylight/state_tile.hpp"

namespace exitance {

/// Bounds of the results of one sensor.
struct SensorIntervals {
    Interval factor;                 ///< Daylight factor, per cent.
    Interval autonomy;               ///< DA
    Interval continuous;             ///< Continuous DA
    Interval electric_hours;         ///< Hours at full power of dimmed electric light.
    std::array<Interval, 4> useful;  ///< UDI
    Interval reached;                ///< Illuminance reached in half of the daylight hours, lx.
};

/// Results of a year at one sensor.
struct SensorResults {
    DaylightMetrics metrics;
    double reached = 0;   ///< Illuminance reached in half of the daylight hours, lx.
    double sunlight = 0;  ///< Hours of direct sunlight on a cloudless day.
    SensorIntervals intervals;
    LinearResults linear;
    SpreadResult factor, autonomy;  ///< Daylight factor and DA, for the intervals of all sensors together.
};

/// Calls f with every number of the results of a sensor, in a fixed order, to store and restore them.
template <class Results, class F>
void for_each_number(Results& r, const F& f) {
    const auto interval = [&](auto& i) { f(i.low), f(i.high); };
    const auto all = [&](auto& values) {
        for (auto& v : values) f(v);
    };
    const auto spread = [&](auto& s) { f(s.value), f(s.less), f(s.more), all(s.replicates); };
    f(r.metrics.daylight_factor), f(r.metrics.autonomy), f(r.metrics.continuous), f(r.metrics.electric_hours);
    all(r.metrics.useful), f(r.metrics.sunny_hours);
    f(r.reached), f(r.sunlight);
    interval(r.intervals.factor), interval(r.intervals.autonomy), interval(r.intervals.continuous);
    interval(r.intervals.electric_hours), interval(r.intervals.reached);
    for (auto& useful : r.intervals.useful) interval(useful);
    all(r.linear.factor), all(r.linear.lux_hours), spread(r.factor), spread(r.autonomy);
}

/// Results of consecutive sensors.
struct DaylightBlock {
    std::size_t first = 0;                ///< Number of the first sensor.
    DaylightMatrix matrix;                ///< Matrix with a row per sensor.
    std::vector<float> illuminance, sun;  ///< Illuminance and direct sunlight, lx: a row per sensor, a column per hour.
    std::vector<SensorResults> results;
    std::vector<VariantResult> variants;  ///< Sensor by sensor, one per variant of the states.
};

/// Evaluates the hours of a year at sensors. Direct sunlight uses exact visibility; reflected sunlight is computed as
/// if it came from the patches around the sun.
class SensorYears {
  public:
    /// `day`: the day on which SensorResults::sunlight is computed; without it that result is 0. `setting` must outlive
    /// this object.
    SensorYears(const DaylightSetting& setting, const DaylightBias& bias, const std::optional<SunDay>& day);

    /// Evaluates sensors at `places` with their rows of the daylight matrix. `first`: number of the first. All
    /// results are computed once per replicate, which gives their noise: the hours share the noise of a sensor's
    /// coefficients, so that it cannot be found from the hours. O(replicates x
    /// sensors x hours x patches): 1 ms per sensor with 146 patches.
    /// `parts`: the rows of the parts of HourlyStates, if the setting has states. The number of sunny hours is then
    /// that of the first states, as ASE requires; all other results of hours are those of the states.
    DaylightBlock evaluate(std::size_t first, std::span<const SurfacePoint> places, DaylightMatrix matrix,
                           std::span<const StateRows> parts = {}) const;

  private:
    static constexpr std::size_t result_count = 9;
    using Results = std::array<double, result_count>;

    void evaluate_tile(std::size_t first, std::size_t count, std::span<const SurfacePoint> places,
                       std::span<const StateRows> parts, DaylightBlock& block) const;
    Results results_of(double factor, std::span<const float> lux, std::span<const float> sun) const;
    void finish(const std::array<SpreadResult, result_count>& spread, SensorResults& out) const;

    const DaylightSetting& setting_;
    double bias_;
    std::vector<double> overcast_;
    std::vector<std::size_t> daylight_hours_;
    Occluders occluders_;
    YearSuns suns_;
    std::optional<SunlightHours> sunlight_;
};

}  // namespace exitance
