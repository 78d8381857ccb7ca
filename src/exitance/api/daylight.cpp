#include "exitance/daylight.hpp"

#include "exitance/api/inside.hpp"
#include "exitance/io/files/wea_file.hpp"
#include "exitance/io/scenes/sky_words.hpp"
#include "exitance/io/scenes/states_file.hpp"
#include "exitance/what_if/daylight/daylight_results.hpp"

namespace exitance::api {
namespace {

/// The error of options out of range; none if all are within.
std::optional<Error> find_misuse(std::span<const Probe> sensors, const DaylightOptions& options) {
    if (sensors.empty()) return usage("there are no sensors", "sensors");
    if (options.division != 1 && options.division != 2 && options.division != 4)
        return usage("must be 1, 2 or 4", "division");
    if (!(options.error > 0 && options.error <= 1)) return usage("must be above 0 and at most 1", "error");
    if (!(options.ground >= 0 && options.ground < 1)) return usage("must be from 0 to below 1", "ground");
    if (!std::isfinite(options.north)) return usage("must be an angle in degrees", "north");
    return std::nullopt;
}

std::vector<std::string> warnings_of(const Weather& weather, const std::string& epw) {
    std::vector<std::string> out;
    for (const std::string& warning : weather.warnings) out.push_back(epw + ": " + warning);
    if (const std::string partial = weather.not_a_year(); !partial.empty())
        out.push_back(epw + ": " + partial + ": sDA and ASE are defined for whole years");
    return out;
}

void add_metrics(const DaylightResults& results, Daylight& out) {
    for (const SensorResults& sensor : results.sensors) {
        const DaylightMetrics& m = sensor.metrics;
        out.daylight_factor.push_back(m.daylight_factor);
        out.autonomy.push_back(m.autonomy);
        out.useful.push_back(m.useful);
        out.sunny_hours.push_back(m.sunny_hours);
        const SensorIntervals& s = sensor.intervals;
        out.daylight_factor_bounds.push_back({s.factor.low, s.factor.high});
        out.autonomy_bounds.push_back({s.autonomy.low, s.autonomy.high});
    }
}

/// Reads the groups of panes, if the options name a file; else returns none.
Result<std::optional<DaylightStates>> states_for(const DaylightOptions& options, const SceneData& scene,
                                                 const DaylightTask& task) {
    if (options.states.empty()) return std::optional<DaylightStates>();
    if (scene.files.empty())
        return usage("needs a scene that was read from files, which name its panes", "states", "load() reads them");
    exitance::Result<DaylightStates> states = read_states(
        options.states, {scene.files, scene.load, *scene.scene, scene.panes, task.sensors.size(), task.hours.size()});
    if (!states) return to_api(states.error());
    return std::optional(std::move(*states));
}

std::vector<PaneGroup> pane_groups(const DaylightStates& states, std::vector<std::vector<std::uint8_t>> chosen) {
    std::vector<PaneGroup> out;
    for (std::size_t g = 0; g < states.groups.size(); ++g) {
        out.push_back({states.groups[g].name, {}, std::move(chosen[g])});
        for (const PaneState& state : states.groups[g].states) out.back().states.push_back(state.name);
    }
    return out;
}

Result<Daylight> compute(const SceneData& scene, const Weather& weather, std::span<const ProbePoint> sensors,
                         const DaylightOptions& options, Run& run) {
    DaylightTask task;
    task.sensors.assign(sensors.begin(), sensors.end());
    task.grids = {{"", sensors.size()}};
    task.division = options.division, task.error = options.error;
    Daylight out;
    for (const WeatherHour& hour : weather.hours) {
        task.hours.push_back({hour.middle(weather.zone), hour.hour, hour.diffuse_horizontal, hour.direct_normal});
        out.hours.push_back({hour.month, hour.day, hour.hour});
    }
    task.site = {.place = weather.place,
                 .zone = weather.zone,
                 .north = options.north,
                 .ground = options.ground,
                 .efficacy_diffuse = efficacy_of_sky,
                 .efficacy_direct = efficacy_of_sun};
    const Result<std::optional<DaylightStates>> states = states_for(options, scene, task);
    if (!states) return states.error();
    if (*states) task.states = &**states;
    exitance::Result<DaylightResults> found = collect_year(*scene.scene, task, run.progress(), run.stop());
    if (!found) return stopped("the computation of daylight");
    DaylightResults& results = *found;
    add_metrics(results, out);
    out.sensors = results.year.sensors;
    out.illuminance = std::move(results.year.illuminance), out.sun = std::move(results.year.sun);
    out.spatial_autonomy = results.summary.spatial_autonomy;
    out.sunlight_exposure = results.summary.sunlight_exposure;
    if (*states) out.pane_groups = pane_groups(**states, std::move(results.states));
    for (std::size_t v = 0; v < results.variants.size(); ++v) {
        const VariantSummary& s = results.variants[v];
        out.glass_variants.push_back({(*states)->variants[v].name,
                                      s.autonomy,
                                      {s.bounds.low, s.bounds.high},
                                      s.continuous,
                                      s.illuminance,
                                      s.exposure});
    }
    out.warnings = std::move(results.warnings);
    const DaylightError error = worst_of(results.summary.errors);
    out.error_daylight_factor = error.factor, out.error_lux_hours = error.lux_hours;
    if (error.largest() > options.error)
        out.warnings.push_back("the error is above the requested one: finer patches of the sky may be needed");
    return out;
}

}  // namespace

Result<Daylight> daylight(const Scene& scene, const std::string& epw, std::span<const Probe> sensors,
                          const DaylightOptions& options, const Control& control) {
    return take_turn<Daylight>(control, [&](Run& run) -> Result<Daylight> {
        if (const std::optional<Error> misuse = find_misuse(sensors, options)) return *misuse;
        const Result<std::vector<ProbePoint>> points = to_engine(sensors);
        if (!points) return points.error();
        const exitance::Result<Weather> weather = load_weather(epw);
        if (!weather) return to_api(weather.error());
        Result<Daylight> out = compute(scene.data(), *weather, *points, options, run);
        if (!out) return out;
        const std::vector<std::string> warnings = warnings_of(*weather, epw);
        out->warnings.insert(out->warnings.begin(), warnings.begin(), warnings.end());
        return out;
    });
}

}  // namespace exitance::api
