#include <fmt/format.h>

#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/border_points.hpp"
#include "exitance/cli/json_output.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/io/files/epw_file.hpp"
#include "exitance/io/files/probe_file.hpp"
#include "exitance/io/report/daylight_tables.hpp"
#include "exitance/io/scenes/sky_words.hpp"
#include "exitance/io/solution/solution_file.hpp"

namespace exitance {
namespace {

std::vector<DaylightHour> hours_of(const Weather& weather) {
    std::vector<DaylightHour> out;
    for (const WeatherHour& hour : weather.hours)
        out.push_back({hour.middle(weather.zone), hour.hour, hour.diffuse_horizontal, hour.direct_normal});
    return out;
}

std::string as_text(const DaylightResults& results, const std::string& folder) {
    const DaylightSummary& s = results.summary;
    const DaylightProvision::Shares& provision = results.provision.by_illuminance;
    constexpr std::array<const char*, 4> levels{"no level", "minimum", "medium", "high"};
    return fmt::format(
        "daylight   {} sensors, {} hours, {} of them occupied\n"
        "factor     {:.3g}% in the mean (overcast sky)\n"
        "sDA        {:.1f}% of the sensors have 300 lx in half of the occupied hours\n"
        "ASE        {:.1f}% of the sensors have 1000 lx of sun in more than 250 hours\n"
        "EN 17037   {}: 300 lx in half of the daylight hours at {:.1f}% of the sensors, 100 lx at {:.1f}%\n"
        "written    {}\n",
        results.sensors.size(), results.hours.size(), s.occupied_hours, s.mean_daylight_factor,
        100 * s.spatial_autonomy, 100 * s.sunlight_exposure, levels[static_cast<std::size_t>(provision.level())],
        100 * provision.at_target[0], 100 * provision.at_minimum[0], folder);
}

}  // namespace

/// Runs `exitance daylight SOLUTION --epw WEATHER --points SENSORS -o FOLDER`.
ExitCode run(const DaylightArguments& arguments, Terminal& terminal) {
    set_threads(arguments.threads);
    const Result<Weather> weather = load_epw(arguments.epw);
    if (!weather) return terminal.fail(weather.error());
    for (const std::string& warning : weather->warnings)
        terminal.progress().warn(fmt::format("{}: {}", arguments.epw, warning));
    if (const std::string partial = weather->not_a_year(); !partial.empty())
        terminal.progress().warn(fmt::format("{}: {}: sDA, ASE and the levels of EN 17037 are defined for whole years",
                                             arguments.epw, partial));
    const Result<ProbePoints> points = load_probe_points(arguments.points);
    if (!points) return terminal.fail(points.error());
    if (points->size() == 0)
        return terminal.fail(
            {ErrorCode::bad_input, "holds no points", arguments.points, "give one sensor per line: x y z dx dy dz"});
    std::optional<ProbePoints> eyes;
    if (!arguments.eyes.empty()) {
        Result<ProbePoints> read = load_probe_points(arguments.eyes);
        if (!read) return terminal.fail(read.error());
        eyes = std::move(*read);
    }
    const Result<Solution> solution = load_solution(arguments.solution);
    if (!solution) return terminal.fail(solution.error());

    DaylightResults results;
    BorderPoints borders;
    const PlaceFinder places(solution->scene);
    for (std::size_t i = 0; i < points->size(); ++i) {
        results.sensors.push_back({points->points[i], points->normals[i]});
        borders.add(places.find(points->points[i], points->normals[i]).is_between_sides);
    }
    borders.tell(terminal);
    results.hours = hours_of(*weather);
    const DaylightSite site{.place = weather->place,
                            .north = arguments.north,
                            .ground = arguments.ground,
                            .efficacy_diffuse = efficacy_of_sky,
                            .efficacy_direct = efficacy_of_sun};
    const SkyPatches patches(arguments.division);
    results.matrix = make_daylight_matrix(solution->scene, results.sensors, patches, {}, terminal.progress());
    terminal.progress().phase("year");
    results.year = daylight_year(solution->scene, results.sensors, patches, results.matrix, results.hours, site);
    results.metrics = daylight_metrics(results.year, patches, results.matrix, results.hours, site);
    results.summary = summarize(results.metrics, results.hours);
    results.provision = daylight_provision(results.year, results.metrics, results.hours, site);
    results.sunlight = sunlight_hours(solution->scene, results.sensors, site, weather->zone, arguments.sun_day);
    if (eyes) results.eyes = eyes->points, results.views = views_out(solution->scene, results.eyes);
    terminal.progress().phase("write");
    if (const Result<void> written = write_daylight(arguments.output, results); !written)
        return terminal.fail(written.error());
    terminal.progress().finish();
    if (arguments.json)
        terminal.print(values_json(summary_values(results)));
    else if (!arguments.quiet)
        terminal.print(as_text(results, arguments.output));
    return ExitCode::done;
}

}  // namespace exitance
