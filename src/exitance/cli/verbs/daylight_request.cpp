#include "exitance/cli/verbs/daylight_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "exitance/cli/border_points.hpp"
#include "exitance/cli/observers.hpp"
#include "exitance/cli/processes.hpp"
#include "exitance/io/files/probe_file.hpp"
#include "exitance/io/files/text_table.hpp"
#include "exitance/io/files/wea_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/honeybee/honeybee_model.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/io/scenes/sky_words.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/processes/exchange_archived.hpp"
#include "exitance/processes/result_of_all.hpp"

namespace exitance {
namespace {

std::vector<DaylightHour> hours_of(const Weather& weather) {
    std::vector<DaylightHour> out;
    for (const WeatherHour& hour : weather.hours)
        out.push_back({hour.middle(weather.zone), hour.hour, hour.diffuse_horizontal, hour.direct_normal});
    return out;
}

/// The file with the sensors: --points, or the scene itself if it is a Honeybee model; empty for neither.
std::string sensor_file(const DaylightArguments& arguments) {
    if (!arguments.points.empty()) return arguments.points;
    for (const std::string& file : arguments.scene.files)
        if (is_honeybee_file(file)) return file;
    return "";
}

/// Returns the grids of a Honeybee model; for other files, one grid without a name.
std::vector<SensorGrid> grids_of(const std::string& sensors, std::size_t count) {
    if (!is_honeybee_file(sensors)) return {{"", count}};
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

/// Reads the occupied hours: a range of every day, a file with a number per hour, or none for the default.
Result<std::vector<std::uint8_t>> read_occupancy(const std::string& words, const std::vector<DaylightHour>& hours) {
    std::vector<std::uint8_t> out;
    if (words.empty()) return out;
    int from = 0, to = 0;
    char rest = 0;
    if (std::sscanf(words.c_str(), "%2d-%2d%c", &from, &to, &rest) == 2) {
        if (from < 0 || from == to || from > 24 || to > 24)
            return Error{ErrorCode::usage, fmt::format("'{}' is not a part of a day such as 8-18", words), "--occupied",
                         "give two full hours from 0 to 24; 22-6 lasts over midnight"};
        for (const DaylightHour& hour : hours)
            out.push_back(from < to ? hour.hour > from && hour.hour <= to : hour.hour > from || hour.hour <= to);
        return out;
    }
    Result<LineReader> lines = LineReader::open(words);
    if (!lines) return lines.error();
    while (const std::optional<std::string_view> line = lines->next_content()) {
        const std::optional<double> number = parse_number(*line);
        if (!number || !(*number >= 0)) return lines->error("is not a number from 0");
        out.push_back(*number > 0);
    }
    if (lines->failed()) return lines->read_error();
    if (out.size() != hours.size())
        return lines->error(fmt::format("has {} numbers for {} hours of the weather", out.size(), hours.size()));
    if (std::find(out.begin(), out.end(), 1) == out.end())
        return Error{ErrorCode::bad_input, "has no occupied hour", words, "give a number above 0 for occupied hours"};
    return out;
}

/// Reads the sensors in the first process, so that they may come from standard input, and sends them to all.
Result<ProbePoints> read_sensors(const std::string& file) {
    ProbePoints points;
    const Result<void> read = by_first([&]() -> Result<void> {
        Result<ProbePoints> found = load_probe_points(file);
        if (!found) return found.error();
        points = std::move(*found);
        return {};
    });
    if (!read) return read.error();
    return as_first_archived(
        std::move(points), [](auto& archive, ProbePoints& all) { archive(all.points, all.normals); }, "points");
}

}  // namespace

Result<SceneWithNames> read_daylight_scene(const DaylightArguments& arguments, Terminal& terminal) {
    const std::vector<std::string>& files = arguments.scene.files;
    if (files.size() == 1 && ending(files[0]) == ".h5") {
        Result<Solution> solution = all_or_none(load_solution(files[0]));
        if (!solution) return solution.error();
        return SceneWithNames{std::move(solution->scene), {}};
    }
    SceneArguments scene = arguments.scene;
    scene.load.needs_light = false;  // the scene may be dark, since the skies of the year light it
    LoadedScene loaded = load_for_all(scene);
    std::erase_if(loaded.findings, [&](const Finding& f) {
        return f.kind == Finding::Kind::warning &&
               (f.message.starts_with("nothing emits light") ||
                (!arguments.states.empty() && f.message.find("with several states") != std::string::npos));
    });
    terminal.show(loaded.findings);
    if (!loaded.scene) return loaded.scene.error();
    return SceneWithNames{std::move(*loaded.scene), std::move(loaded.panes)};
}

Result<DaylightRequest> read_daylight_request(const DaylightArguments& arguments, const Scene& scene,
                                              Terminal& terminal) {
    const Result<Weather> weather = all_or_none(load_weather(arguments.epw));
    if (!weather) return weather.error();
    warn_of(*weather, arguments.epw, terminal.progress());
    const std::string sensors = sensor_file(arguments);
    if (sensors.empty()) return Error{ErrorCode::usage, "there are no sensors", "--points", "name a file with points"};
    const Result<ProbePoints> points = read_sensors(sensors);
    if (!points) return points.error();
    if (points->size() == 0)
        return Error{ErrorCode::bad_input, "holds no points", sensors, "give one sensor per line: x y z dx dy dz"};
    DaylightRequest out;
    if (!arguments.eyes.empty()) {
        Result<ProbePoints> eyes = load_probe_points(arguments.eyes);
        if (!eyes) return eyes.error();
        out.eyes = std::move(eyes->points);
    }
    if (!arguments.views.empty()) {
        const Result<std::vector<Observer>> views = load_views(arguments.views);
        if (!views) return views.error();
        for (const Observer& view : *views) out.views.push_back({view.eye, view.view});
    }
    BorderPoints borders;
    const PlaceFinder places(scene);
    for (std::size_t i = 0; i < points->size(); ++i) {
        out.task.sensors.push_back({points->points[i], points->normals[i]});
        borders.add(places.find(points->points[i], points->normals[i]).is_between_sides);
    }
    borders.tell(terminal);
    out.task.hours = hours_of(*weather);
    out.task.site = {.place = weather->place,
                     .zone = weather->zone,
                     .north = arguments.north,
                     .ground = arguments.ground,
                     .efficacy_diffuse = efficacy_of_sky,
                     .efficacy_direct = efficacy_of_sun};
    out.task.grids = grids_of(sensors, points->size());
    out.task.division = arguments.division, out.task.error = arguments.error;
    out.task.sun_day = arguments.sun_day;
    out.task.criteria = arguments.criteria;
    Result<std::vector<std::uint8_t>> occupied = read_occupancy(arguments.occupied, out.task.hours);
    if (!occupied) return occupied.error();
    out.task.criteria.occupied = std::move(*occupied);
    out.formats = {arguments.hours, arguments.matrix, is_honeybee_file(sensors)};
    return out;
}

Result<void> read_daylight_states(const DaylightArguments& arguments, const SceneWithNames& read,
                                  DaylightRequest& request) {
    if (arguments.states.empty()) return {};
    Result<DaylightStates> states =
        read_states(arguments.states, {arguments.scene.files, arguments.scene.load, read.scene, read.panes,
                                       request.task.sensors.size(), request.task.hours.size()});
    if (!states) return states.error();
    request.states = std::move(*states), request.task.states = &*request.states;
    return {};
}

}  // namespace exitance
