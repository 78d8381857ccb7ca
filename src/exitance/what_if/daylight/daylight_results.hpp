#pragma once

#include <functional>
#include <memory>

#include "exitance/what_if/daylight/daylight_search.hpp"
#include "exitance/what_if/daylight/daylight_totals.hpp"
#include "exitance/what_if/daylight/glare_year.hpp"
#include "exitance/what_if/daylight/state_choice.hpp"

namespace exitance {

/// Input of a daylight simulation over a year.
struct DaylightTask {
    std::vector<ProbePoint> sensors;
    std::vector<SensorGrid> grids;  ///< Grids that together contain all sensors, in their order.
    std::vector<DaylightHour> hours;
    DaylightSite site;
    DaylightCriteria criteria;
    int division = 1;               ///< Parts into which Tregenza's patches are divided in each direction: 1, 2 or 4.
    double error = 0.02;            ///< Requested error of every grid.
    std::optional<SunDay> sun_day;  ///< Day for which hours of sunlight are counted.
    const DaylightStates* states = nullptr;  ///< States of panes; null: they do not change. Must outlive the task.
};

/// Receives the results of consecutive sensors, in order. An error ends the simulation.
using DaylightSink = std::function<Result<void>(const DaylightBlock&)>;

/// Consecutive sensors.
struct SensorRange {
    std::size_t first = 0, count = 0;
};
/// Returns the sensors of part `part` (from 1) of `parts`. The parts differ by at most one sensor.
constexpr SensorRange sensors_of_part(std::size_t part, std::size_t parts, std::size_t sensors) {
    const std::size_t first = sensors * (part - 1) / parts;
    return {first, sensors * part / parts - first};
}

/// Computes a year in two steps: the light on the elements, which is common to all sensors and can be kept, and the
/// results of any sensors. Memory: that of the elements, of at most 2048 random sensors, and of a block of sensors.
/// Several processes divide the rays and the sensors, and all get all results; every function is collective.
class DaylightSimulation {
  public:
    /// All arguments must outlive this object.
    DaylightSimulation(const Scene& scene, const DaylightTask& task, Progress& progress, const StopRequest& stop);
    DaylightSimulation(const Scene&, const DaylightTask&, Progress&, StopRequest&&) = delete;
    ~DaylightSimulation();
    DaylightSimulation(const DaylightSimulation&) = delete;
    DaylightSimulation& operator=(const DaylightSimulation&) = delete;

    /// Finds the light for the requested error. Error: ErrorCode::limit after a stop request.
    Result<void> find_light();
    /// Takes the light that find_light() has found for an equal scene and task. Returns false if it does not fit them.
    bool take(DaylightLight light);
    /// Requires that the light was found or taken.
    const DaylightLight& light() const;
    /// The states of all hours, which find_light() chooses; null if the task has none.
    const HourlyStates* states() const;
    /// Sentences about light of states that may be wrong.
    std::vector<std::string> warnings() const;
    /// Sentences about sensors outdoors, below floors and inside of bodies (find_misplaced).
    std::vector<std::string> sensor_warnings() const;

    /// Passes the results of sensors to `sink`, block by block. The bits of a sensor's results do not depend on the
    /// range in which it is. Errors: ErrorCode::limit after a stop request, or that of the sink.
    Result<void> evaluate(SensorRange range, const DaylightSink& sink) const;

    /// Returns the daylight glare of the year at views: eyes (metres) with their lines of sight. `threshold`: luminance
    /// of sources, cd/m^2. Error: ErrorCode::limit after a stop request.
    Result<std::vector<GlareYear>> glare(std::span<const ProbePoint> views, double threshold) const;

  private:
    struct SceneLight;
    struct Data;
    void find_light(SceneLight& scene);
    void choose_states();
    std::vector<StateRows> state_rows(std::size_t first, std::span<const SurfacePoint> places,
                                      std::vector<DaylightMatrix> through) const;
    std::unique_ptr<Data> data_;
};

/// Evaluates all sensors with daylight coefficients that were computed before, such as by another program: a row per
/// sensor, lx for 1 cd/m^2 of each patch. The sun is spread over the patches around it, also for its straight light, so
/// that direct sunlight is not separated; noise and bias are not known.
Result<void> evaluate_coefficients(const Scene& scene, const DaylightTask& task, std::span<const float> coefficients,
                                   const DaylightSink& sink, const StopRequest& stop);

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
    /// State of each group of panes in every hour; empty without states.
    std::vector<std::vector<std::uint8_t>> states;
    std::vector<VariantSummary> variants;  ///< One summary per variant of the states.
    std::vector<std::string> warnings;     ///< See DaylightSimulation::warnings().
};

/// Finds the light, evaluates all sensors and keeps all results. About 75 kB per sensor.
Result<DaylightResults> collect_year(const Scene& scene, const DaylightTask& task, Progress& progress,
                                     const StopRequest& stop);

}  // namespace exitance
