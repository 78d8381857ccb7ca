#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/border_points.hpp"
#include "exitance/cli/json_output.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/io/files/epw_file.hpp"
#include "exitance/io/files/probe_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/report/daylight_tables.hpp"
#include "exitance/io/report/honeybee_results.hpp"
#include "exitance/io/scenes/honeybee/honeybee_model.hpp"
#include "exitance/io/scenes/scene_file.hpp"
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

std::string as_text(const DaylightSummary& s, std::size_t hours, const std::string& folder) {
    const DaylightProvision::Shares& provision = s.provision.by_illuminance;
    const DaylightError error = worst_of(s.errors);
    constexpr std::array<const char*, 4> levels{"no level", "minimum", "medium", "high"};
    return fmt::format(
        "daylight   {} sensors, {} hours, {} of them occupied\n"
        "factor     {:.3g}% in the mean (overcast sky; 95%: {:.3g} to {:.3g}%)\n"
        "error      {:.2g}% of the daylight factors, {:.2g}% of the lux hours (RMS, worst grid)\n"
        "sDA        {:.1f}% of the sensors have 300 lx in half of the occupied hours (95%: {:.1f} to {:.1f}%)\n"
        "ASE        {:.1f}% of the sensors have 1000 lx of sun in more than 250 hours\n"
        "EN 17037   {}: 300 lx in half of the daylight hours at {:.1f}% of the sensors, 100 lx at {:.1f}%\n"
        "written    {}\n",
        s.sensors, hours, s.occupied_hours, s.mean_daylight_factor, s.mean_factor.low, s.mean_factor.high,
        100 * error.factor, 100 * error.lux_hours, 100 * s.spatial_autonomy, 100 * s.spatial_autonomy_bounds.low,
        100 * s.spatial_autonomy_bounds.high, 100 * s.sunlight_exposure,
        levels[static_cast<std::size_t>(provision.level())], 100 * provision.at_target[0],
        100 * provision.at_minimum[0], folder);
}

/// The scene of scene files or of a solution. A scene needs no light of its own.
Result<Scene> scene_of(const DaylightArguments& arguments, Terminal& terminal) {
    const std::vector<std::string>& files = arguments.scene.files;
    if (files.size() == 1 && ending(files[0]) == ".h5") {
        Result<Solution> solution = load_solution(files[0]);
        if (!solution) return solution.error();
        return std::move(solution->scene);
    }
    CheckedScene checked = load_scene(files, arguments.scene.load);
    std::erase_if(checked.findings, [](const Finding& f) {
        return f.kind == Finding::Kind::warning && f.message.starts_with("nothing emits light");
    });
    terminal.show(checked.findings);
    return std::move(checked.scene);
}

/// The file with the sensors: --points, or the scene itself if it is a Honeybee model; empty for neither.
std::string sensor_file(const DaylightArguments& arguments) {
    if (!arguments.points.empty()) return arguments.points;
    for (const std::string& file : arguments.scene.files)
        if (ending(file) == ".hbjson") return file;
    return "";
}

/// The grids of a Honeybee model; one without a name for other files.
std::vector<SensorGrid> grids_of(const std::string& sensors, std::size_t count) {
    if (ending(sensors) != ".hbjson") return {{"", count}};
    std::vector<SensorGrid> grids;
    for (const HoneybeeGrid& grid : read_honeybee_model(sensors).grids)
        grids.push_back({grid.name, grid.points.size()});
    return grids;
}

void warn_of(const Weather& weather, const std::string& file, Progress& progress) {
    for (const std::string& warning : weather.warnings) progress.warn(fmt::format("{}: {}", file, warning));
    if (const std::string partial = weather.not_a_year(); !partial.empty())
        progress.warn(
            fmt::format("{}: {}: sDA, ASE and the levels of EN 17037 are defined for whole years", file, partial));
}

/// Prints the results. Returns the exit code: whether every grid has the requested error.
ExitCode tell(const DaylightTask& task, const DaylightResults& results, const DaylightArguments& arguments,
              Terminal& terminal) {
    if (arguments.json)
        terminal.print(values_json(summary_values(task, results)));
    else if (!arguments.quiet)
        terminal.print(as_text(results.summary, task.hours.size(), arguments.output));
    const double error = worst_of(results.summary.errors).largest();
    if (error <= arguments.error) return ExitCode::done;
    terminal.progress().warn(fmt::format(
        "the error of {:.2g}% is above the requested {:.2g}%{}", 100 * error, 100 * arguments.error,
        results.summary.bias.patches > arguments.error ? ": the patches of the sky are too coarse (--sky-patches)"
                                                       : ""));
    return ExitCode::demand_not_reached;
}

}  // namespace

/// Runs `exitance daylight SCENE --epw WEATHER --points SENSORS -o FOLDER`.
ExitCode run(const DaylightArguments& arguments, Terminal& terminal) {
    set_threads(arguments.threads);
    const Result<Weather> weather = load_epw(arguments.epw);
    if (!weather) return terminal.fail(weather.error());
    warn_of(*weather, arguments.epw, terminal.progress());
    const std::string sensors = sensor_file(arguments);
    if (sensors.empty())
        return terminal.fail({ErrorCode::usage, "there are no sensors", "--points", "name a file with points"});
    const Result<ProbePoints> points = load_probe_points(sensors);
    if (!points) return terminal.fail(points.error());
    if (points->size() == 0)
        return terminal.fail(
            {ErrorCode::bad_input, "holds no points", sensors, "give one sensor per line: x y z dx dy dz"});
    std::optional<ProbePoints> eyes;
    if (!arguments.eyes.empty()) {
        Result<ProbePoints> read = load_probe_points(arguments.eyes);
        if (!read) return terminal.fail(read.error());
        eyes = std::move(*read);
    }
    const Result<Scene> scene = scene_of(arguments, terminal);
    if (!scene) return terminal.fail(scene.error());

    DaylightTask task;
    BorderPoints borders;
    const PlaceFinder places(*scene);
    for (std::size_t i = 0; i < points->size(); ++i) {
        task.sensors.push_back({points->points[i], points->normals[i]});
        borders.add(places.find(points->points[i], points->normals[i]).is_between_sides);
    }
    borders.tell(terminal);
    task.hours = hours_of(*weather);
    task.site = {.place = weather->place,
                 .zone = weather->zone,
                 .north = arguments.north,
                 .ground = arguments.ground,
                 .efficacy_diffuse = efficacy_of_sky,
                 .efficacy_direct = efficacy_of_sun};
    task.grids = grids_of(sensors, points->size());
    task.division = arguments.division, task.error = arguments.error, task.sun_day = arguments.sun_day;
    Result<DaylightResults> found = collect_year(*scene, task, terminal.progress(), terminal.limits().stop());
    if (!found) return terminal.fail(found.error());
    DaylightResults& results = *found;
    if (eyes) results.eyes = eyes->points, results.views = views_out(*scene, results.eyes);
    terminal.progress().phase("write");
    if (const Result<void> written = write_daylight(arguments.output, task, results); !written)
        return terminal.fail(written.error());
    if (ending(sensors) == ".hbjson") {
        const std::string folder = (std::filesystem::path(arguments.output) / "honeybee").string();
        if (const Result<void> written = write_honeybee_results(folder, task, results); !written)
            return terminal.fail(written.error());
    }
    terminal.progress().finish();
    return tell(task, results, arguments, terminal);
}

}  // namespace exitance
