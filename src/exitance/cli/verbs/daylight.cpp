#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/border_points.hpp"
#include "exitance/cli/common_stop.hpp"
#include "exitance/cli/json_output.hpp"
#include "exitance/cli/observers.hpp"
#include "exitance/cli/processes.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/io/files/probe_file.hpp"
#include "exitance/io/files/radiance_matrix.hpp"
#include "exitance/io/files/text_table.hpp"
#include "exitance/io/files/wea_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/report/daylight_light_file.hpp"
#include "exitance/io/report/daylight_parts.hpp"
#include "exitance/io/report/daylight_tables.hpp"
#include "exitance/io/report/glare_tables.hpp"
#include "exitance/io/scenes/honeybee/honeybee_model.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/io/scenes/sky_words.hpp"
#include "exitance/io/scenes/states_file.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/processes/exchange_archived.hpp"
#include "exitance/processes/result_of_all.hpp"
#include "exitance/what_if/daylight/lm83.hpp"

namespace exitance {
namespace {

std::vector<DaylightHour> hours_of(const Weather& weather) {
    std::vector<DaylightHour> out;
    for (const WeatherHour& hour : weather.hours)
        out.push_back({hour.middle(weather.zone), hour.hour, hour.diffuse_horizontal, hour.direct_normal});
    return out;
}

std::string as_text(const DaylightSummary& s, const DaylightTask& task, const std::string& folder) {
    const auto conformity = [](const std::vector<std::string>& deviations) {
        return deviations.empty() ? std::string("conforms to LM-83")
                                  : fmt::format("not LM-83: {}", fmt::join(deviations, "; "));
    };
    const DaylightProvision::Shares& provision = s.provision.by_illuminance;
    const DaylightError error = worst_of(s.errors);
    constexpr std::array<const char*, 4> levels{"no level", "minimum", "medium", "high"};
    const std::string told =
        std::isnan(error.factor)
            ? "not known: the coefficients were read"
            : fmt::format("{:.2g}% of the daylight factors, {:.2g}% of the lux hours (RMS, worst grid)",
                          100 * error.factor, 100 * error.lux_hours);
    return fmt::format(
        "daylight   {} sensors, {} hours, {} of them occupied\n"
        "factor     {:.3g}% in the mean (overcast sky; 95%: {:.3g} to {:.3g}%)\n"
        "error      {}\n"
        "sDA        {:.1f}% of the sensors have {:g} lx in half of the occupied hours (95%: {:.1f} to {:.1f}%)\n"
        "           {}\n"
        "cDA        {:.1f}% in the mean; dimmed electric light takes {:.0f} hours at full power\n"
        "ASE        {:.1f}% of the sensors have 1000 lx of sun in more than 250 hours\n"
        "           {}\n"
        "EN 17037   {}: 300 lx in half of the daylight hours at {:.1f}% of the sensors, 100 lx at {:.1f}%\n"
        "written    {}\n",
        s.sensors, task.hours.size(), s.occupied_hours, s.mean_daylight_factor, s.mean_factor.low, s.mean_factor.high,
        told, 100 * s.spatial_autonomy, task.criteria.target, 100 * s.spatial_autonomy_bounds.low,
        100 * s.spatial_autonomy_bounds.high, conformity(s.lm83.autonomy), 100 * s.continuous_autonomy,
        s.electric_hours, 100 * s.sunlight_exposure, conformity(s.lm83.exposure),
        levels[static_cast<std::size_t>(provision.level())], 100 * provision.at_target[0],
        100 * provision.at_minimum[0], folder);
}

/// A scene, and the names of its panes if it comes from scene files.
struct SceneWithNames {
    Scene scene;
    std::vector<NamedPane> panes;
};

/// The scene of scene files or of a solution. A scene needs no light of its own.
Result<SceneWithNames> scene_of(const DaylightArguments& arguments, Terminal& terminal) {
    const std::vector<std::string>& files = arguments.scene.files;
    if (files.size() == 1 && ending(files[0]) == ".h5") {
        Result<Solution> solution = all_or_none(load_solution(files[0]));
        if (!solution) return solution.error();
        return SceneWithNames{std::move(solution->scene), {}};
    }
    LoadedScene loaded = load_for_all(arguments.scene);
    std::erase_if(loaded.findings, [&](const Finding& f) {
        return f.kind == Finding::Kind::warning &&
               (f.message.starts_with("nothing emits light") ||
                (!arguments.states.empty() && f.message.find("with several states") != std::string::npos));
    });
    terminal.show(loaded.findings);
    if (!loaded.scene) return loaded.scene.error();
    return SceneWithNames{std::move(*loaded.scene), std::move(loaded.panes)};
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

/// A simulation, the eye points for views out, and the files to write.
struct Request {
    DaylightTask task;
    std::vector<Point> eyes;
    std::vector<ProbePoint> views;  ///< For glare.
    DaylightFormats formats;
    std::optional<DaylightStates> states;  ///< States of panes, which the task uses.
};

/// Prints the results. Returns the exit code: whether every grid has the requested error.
ExitCode tell(const Request& request, const DaylightSummary& summary, std::span<const ViewOut> views,
              const DaylightArguments& arguments, Terminal& terminal) {
    if (arguments.json)
        terminal.print(
            values_json(summary_values(request.task, summary, views),
                        {{"sDA_deviations", summary.lm83.autonomy}, {"ASE_deviations", summary.lm83.exposure}}));
    else if (!arguments.quiet)
        terminal.print(as_text(summary, request.task, arguments.output));
    const double error = worst_of(summary.errors).largest();
    if (error <= arguments.error || !arguments.coefficients.empty()) return ExitCode::done;
    terminal.progress().warn(fmt::format(
        "the error of {:.2g}% is above the requested {:.2g}%{}", 100 * error, 100 * arguments.error,
        summary.bias.patches > arguments.error ? ": the patches of the sky are too coarse (--sky-patches)" : ""));
    return ExitCode::demand_not_reached;
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

/// Reads weather, sensors and eye points.
Result<Request> read_request(const DaylightArguments& arguments, const Scene& scene, Terminal& terminal) {
    const Result<Weather> weather = all_or_none(load_weather(arguments.epw));
    if (!weather) return weather.error();
    warn_of(*weather, arguments.epw, terminal.progress());
    const std::string sensors = sensor_file(arguments);
    if (sensors.empty()) return Error{ErrorCode::usage, "there are no sensors", "--points", "name a file with points"};
    const Result<ProbePoints> points = read_sensors(sensors);
    if (!points) return points.error();
    if (points->size() == 0)
        return Error{ErrorCode::bad_input, "holds no points", sensors, "give one sensor per line: x y z dx dy dz"};
    Request out;
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
    out.formats = {arguments.hours, arguments.matrix, ending(sensors) == ".hbjson"};
    return out;
}

/// Passes the results of all sensors to the files, in the first process; `pass` calls its argument with every block.
/// Returns the totals.
template <class Pass>
Result<DaylightSummary> write_all(const Request& request, const DaylightBias& bias, std::span<const ViewOut> views,
                                  const std::string& output, const Pass& pass,
                                  const std::optional<GlareSummary>& glare = {}) {
    std::optional<DaylightFiles> files;
    const Result<void> opened = by_first([&]() -> Result<void> {
        Result<DaylightFiles> made = DaylightFiles::create(output, request.task, request.formats);
        if (!made) return made.error();
        files.emplace(std::move(*made));
        return {};
    });
    if (!opened) return opened.error();
    DaylightTotals totals(request.task.grids, request.task.hours, request.task.site, request.task.criteria);
    const std::size_t variants = request.states ? request.states->variants.size() : 0;
    VariantTotals of_variants(variants);
    const Result<void> passed = pass([&](const DaylightBlock& block) {
        for (const SensorResults& sensor : block.results) totals.add(sensor);
        for (std::size_t i = 0; i < block.variants.size(); i += variants)
            of_variants.add(std::span(block.variants).subspan(i, variants));
        return files ? files->add(block) : Result<void>();
    });
    if (!passed) return passed.error();
    if (variants > 0)
        if (const Result<void> written = write_variants(output, request.task, of_variants.summaries()); !written)
            return written.error();
    DaylightSummary summary = totals.summary(bias);
    summary.glare = glare;
    summary.lm83 = lm83_deviations(request.task, !std::isnan(bias.elements));
    const Result<void> written = by_first([&] { return files->finish(summary, request.eyes, views); });
    if (!written) return written.error();
    return summary;
}

/// The light that all parts share.
std::string light_file(const std::string& output) {
    return (std::filesystem::path(output) / "light.h5").string();
}

/// Takes the kept light, or finds it and keeps it.
Result<void> share_light(DaylightSimulation& simulation, const std::string& fingerprint, const std::string& output) {
    bool is_kept = false;
    const Result<void> read = by_first([&]() -> Result<void> {
        const Result<std::optional<DaylightLight>> kept = read_daylight_light(light_file(output), fingerprint);
        if (!kept) return kept.error();
        is_kept = kept->has_value();
        return {};
    });
    if (!read) return read;
    if (as_first(is_kept)) {  // other processes look only now, since another part may write the file meanwhile
        Result<std::optional<DaylightLight>> kept = all_or_none(read_daylight_light(light_file(output), fingerprint));
        if (!kept) return kept.error();
        const bool is_taken = *kept && simulation.take(std::move(**kept));
        if (largest_of_all(is_taken ? 0 : 1) == 0) return {};
    }
    if (const Result<void> found = simulation.find_light(); !found) return found;
    return by_first([&] { return write_daylight_light(light_file(output), fingerprint, simulation.light()); });
}

/// Evaluates and writes one part of the sensors.
Result<void> run_part(const Scene& scene, const Request& request, const DaylightArguments& arguments,
                      const StopRequest& stop, Terminal& terminal) {
    const std::string fingerprint = as_first(fingerprint_of(scene, request.task), "agreement");
    const std::string folder = arguments.part->folder(arguments.output);
    std::error_code failure;
    if (is_first_process()) std::filesystem::create_directories(folder, failure);
    DaylightSimulation simulation(scene, request.task, terminal.progress(), stop);
    if (const Result<void> shared = share_light(simulation, fingerprint, arguments.output); !shared) return shared;
    const SensorRange range = sensors_of_part(arguments.part->part, arguments.part->parts, request.task.sensors.size());
    std::optional<DaylightPartWriter> writer;
    const Result<void> opened = by_first([&]() -> Result<void> {
        Result<DaylightPartWriter> made = DaylightPartWriter::create(folder, request.task, range.count,
                                                                     simulation.light().elements.columns, fingerprint);
        if (!made) return made.error();
        writer.emplace(std::move(*made));
        return {};
    });
    if (!opened) return opened;
    const auto add = [&](const DaylightBlock& block) -> Result<void> {
        if (writer) writer->add(block);
        return {};
    };
    if (const Result<void> done = simulation.evaluate(range, add); !done) return done;
    return by_first([&] { return writer->finish(); });
}

/// Writes the results of all parts, as those of a run of the whole.
Result<DaylightSummary> merge_parts(const Scene& scene, const Request& request, std::span<const ViewOut> views,
                                    const std::string& output) {
    const std::string fingerprint = fingerprint_of(scene, request.task);
    const Result<std::size_t> parts = count_daylight_parts(output);
    if (!parts) return parts.error();
    const Result<std::optional<DaylightLight>> light = read_daylight_light(light_file(output), fingerprint);
    if (!light) return light.error();
    if (!*light)
        return Error{ErrorCode::bad_input, "is missing or belongs to another scene, weather or option",
                     light_file(output), "run a part again"};
    return write_all(request, (*light)->bias, views, output, [&](const DaylightSink& sink) {
        return merge_daylight_parts(output, *parts, request.task, fingerprint, sink);
    });
}

/// Reads the matrix of another program as daylight coefficients: a row per sensor, a column per patch.
Result<std::vector<float>> read_coefficients(const std::string& path, const DaylightTask& task) {
    const Result<RadianceMatrix> matrix = read_radiance_matrix(path);
    if (!matrix) return matrix.error();
    const std::size_t patches = SkyPatches::count(static_cast<std::size_t>(task.division));
    if (matrix->rows != task.sensors.size() || matrix->columns != patches ||
        (matrix->components != 1 && matrix->components != bands))
        return Error{ErrorCode::bad_input,
                     fmt::format("has {} x {} entries of {} components, for {} sensors and {} patches", matrix->rows,
                                 matrix->columns, matrix->components, task.sensors.size(), patches),
                     path, "give --sky-patches and --points as for the matrix"};
    for (std::size_t k = 0; k < matrix->values.size(); ++k)
        if (!(matrix->values[k] >= 0 && std::isfinite(matrix->values[k]))) {
            const std::size_t entry = k / matrix->components;
            return Error{ErrorCode::bad_input,
                         fmt::format("has {} in row {}, column {}: coefficients are numbers from 0", matrix->values[k],
                                     entry / matrix->columns + 1, entry % matrix->columns + 1),
                         path, "write the matrix again"};
        }
    if (matrix->components == 1) return matrix->values;
    std::vector<float> out;
    for (std::size_t k = 0; k < matrix->values.size(); k += bands) {
        Spectrum light;
        for (std::size_t b = 0; b < bands; ++b) light[b] = double(matrix->values[k + b]);
        out.push_back(static_cast<float>(luminous_sum(light)));
    }
    return out;
}

/// Evaluates and writes all sensors with given coefficients, whose error is not known.
Result<DaylightSummary> run_coefficients(const Scene& scene, const Request& request, std::span<const ViewOut> views,
                                         const DaylightArguments& arguments, const StopRequest& stop) {
    const Result<std::vector<float>> coefficients =
        all_or_none(read_coefficients(arguments.coefficients, request.task));
    if (!coefficients) return coefficients.error();
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    return write_all(request, {unknown, unknown, 0}, views, arguments.output, [&](const DaylightSink& sink) {
        return evaluate_coefficients(scene, request.task, *coefficients, sink, stop);
    });
}

/// Evaluates and writes daylight glare at the views.
Result<GlareSummary> write_year_of_glare(const DaylightSimulation& simulation, const Request& request,
                                         const DaylightArguments& arguments) {
    const Result<std::vector<GlareYear>> years = simulation.glare(request.views, GlareThreshold().value);
    if (!years) return years.error();
    const Result<void> written = by_first([&] {
        return write_glare(arguments.output, request.views, *years, request.task.hours, request.formats.hours);
    });
    if (!written) return written.error();
    return summary_of(*years);
}

/// Writes the states of all hours, and warns if their light may be wrong.
Result<void> tell_states(const DaylightSimulation& simulation, const Request& request,
                         const DaylightArguments& arguments, Terminal& terminal) {
    if (!simulation.states()) return {};
    constexpr double small_share = 0.01;  // 1% of the light: below the default error
    if (simulation.states()->twice > small_share)
        terminal.progress().warn(fmt::format(
            "{:.2g}% of the light crosses panes of groups twice, and counts as if it crossed them once: intervals of "
            "hours with changed states are wider by it",
            100 * simulation.states()->twice));
    if (simulation.error_of_states() > arguments.error)
        terminal.progress().warn(
            fmt::format("the error of {:.2g}% with the geometry of a state is above the requested {:.2g}%",
                        100 * simulation.error_of_states(), 100 * arguments.error));
    return write_states(arguments.output, *request.states, *simulation.states(), request.task.hours);
}

/// Evaluates and writes all sensors.
Result<DaylightSummary> run_whole(const Scene& scene, const Request& request, std::span<const ViewOut> views,
                                  const DaylightArguments& arguments, const StopRequest& stop, Terminal& terminal) {
    if (!arguments.coefficients.empty()) return run_coefficients(scene, request, views, arguments, stop);
    DaylightSimulation simulation(scene, request.task, terminal.progress(), stop);
    if (const Result<void> found = simulation.find_light(); !found) return found.error();
    if (const Result<void> told = tell_states(simulation, request, arguments, terminal); !told) return told.error();
    std::optional<GlareSummary> glare;
    if (!request.views.empty()) {
        const Result<GlareSummary> written = write_year_of_glare(simulation, request, arguments);
        if (!written) return written.error();
        glare = *written;
    }
    const auto pass = [&](const DaylightSink& sink) {
        return simulation.evaluate({0, request.task.sensors.size()}, sink);
    };
    return write_all(request, simulation.light().bias, views, arguments.output, pass, glare);
}

}  // namespace

/// Runs `exitance daylight SCENE --epw WEATHER --points SENSORS -o FOLDER`.
ExitCode run(const DaylightArguments& arguments, Terminal& terminal) {
    if (arguments.merge && processes() > 1)
        return terminal.fail(
            Error{ErrorCode::usage, "merges files, which one process does", "--merge", "run it without mpirun"});
    if (!arguments.states.empty() && processes() > 1)
        return terminal.fail(Error{ErrorCode::usage, "states of panes are evaluated by one process", "--states",
                                   "run it without mpirun; --threads uses all cores"});
    set_threads(arguments.threads);
    const Result<SceneWithNames> read = scene_of(arguments, terminal);
    if (!read) return terminal.fail(read.error());
    const Scene* const scene = &read->scene;
    Result<Request> request = all_or_none(read_request(arguments, *scene, terminal));
    if (!request) return terminal.fail(request.error());
    if (!arguments.states.empty()) {
        Result<DaylightStates> states =
            read_states(arguments.states, {arguments.scene.files, arguments.scene.load, *scene, read->panes,
                                           request->task.sensors.size(), request->task.hours.size()});
        if (!states) return terminal.fail(states.error());
        request->states = std::move(*states), request->task.states = &*request->states;
    }
    const CommonStop common(terminal, terminal.limits().stop());
    const StopRequest& stop = common.request();
    if (arguments.part) {
        const Result<void> done = run_part(*scene, *request, arguments, stop, terminal);
        if (!done) return terminal.fail(done.error());
        terminal.progress().finish();
        return ExitCode::done;
    }
    const std::vector<ViewOut> views = views_out(*scene, request->eyes);
    const Result<DaylightSummary> summary = arguments.merge
                                                ? merge_parts(*scene, *request, views, arguments.output)
                                                : run_whole(*scene, *request, views, arguments, stop, terminal);
    if (!summary) return terminal.fail(summary.error());
    terminal.progress().finish();
    return as_first(tell(*request, *summary, views, arguments, terminal));
}

}  // namespace exitance
