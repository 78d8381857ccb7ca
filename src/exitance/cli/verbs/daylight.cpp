#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "exitance/base/distinct_numbers.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/cli/common_stop.hpp"
#include "exitance/cli/json_output.hpp"
#include "exitance/cli/processes.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/cli/verbs/daylight_request.hpp"
#include "exitance/io/files/radiance_matrix.hpp"
#include "exitance/io/files/text_table.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/report/daylight_light_file.hpp"
#include "exitance/io/report/daylight_parts.hpp"
#include "exitance/io/report/daylight_tables.hpp"
#include "exitance/io/report/glare_tables.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/processes/result_of_all.hpp"
#include "exitance/what_if/daylight/lm83.hpp"

namespace exitance {
namespace {

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

/// Prints the results. Returns the exit code: whether every grid has the requested error.
ExitCode tell(const DaylightRequest& request, const DaylightSummary& summary, std::span<const ViewOut> views,
              const DaylightArguments& arguments, Terminal& terminal) {
    if (arguments.json)
        terminal.print(
            values_json(summary_values(request.task, summary, views),
                        {{"sDA_deviations", summary.lm83.autonomy}, {"ASE_deviations", summary.lm83.exposure}}));
    else if (!arguments.quiet)
        terminal.print(as_text(summary, request.task, arguments.output));
    const double error = worst_of(summary.errors).largest();
    if (error <= arguments.error || !arguments.coefficients.empty()) return ExitCode::done;
    const NumberTexts percents = distinct_percents(error, arguments.error, 2);
    terminal.progress().warn(fmt::format(
        "the error of {}% is above the requested {}%{}", percents.first, percents.second,
        summary.bias.patches > arguments.error ? ": the patches of the sky are too coarse (--sky-patches)" : ""));
    return ExitCode::demand_not_reached;
}

/// Passes the results of all sensors to the files, in the first process; `pass` calls its argument with every block.
/// Returns the totals.
template <class Pass>
Result<DaylightSummary> write_all(const DaylightRequest& request, const DaylightBias& bias,
                                  std::span<const ViewOut> views, const std::string& output, const Pass& pass,
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

/// File with the light on the elements, which all parts of a simulation share.
std::string light_file(const std::string& output) {
    return (std::filesystem::path(output) / "light.h5").string();
}

/// Reads the stored light, or computes and stores it.
Result<void> share_light(DaylightSimulation& simulation, const std::string& fingerprint, const std::string& output) {
    bool is_kept = false;
    const Result<void> read = by_first([&]() -> Result<void> {
        const Result<std::optional<DaylightLight>> kept = read_daylight_light(light_file(output), fingerprint);
        if (!kept) return kept.error();
        is_kept = kept->has_value();
        return {};
    });
    if (!read) return read;
    if (as_first(is_kept)) {  // the first process decides, since another part may write the file meanwhile
        Result<std::optional<DaylightLight>> kept = all_or_none(read_daylight_light(light_file(output), fingerprint));
        if (!kept) return kept.error();
        const bool is_taken = *kept && simulation.take(std::move(**kept));
        if (largest_of_all(is_taken ? 0 : 1) == 0) return {};
    }
    if (const Result<void> found = simulation.find_light(); !found) return found;
    return by_first([&] { return write_daylight_light(light_file(output), fingerprint, simulation.light()); });
}

/// Evaluates and writes one part of the sensors.
Result<void> run_part(const Scene& scene, const DaylightRequest& request, const DaylightArguments& arguments,
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

/// Writes the results of all parts as one undivided run would write them.
Result<DaylightSummary> merge_parts(const Scene& scene, const DaylightRequest& request, std::span<const ViewOut> views,
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
Result<DaylightSummary> run_coefficients(const Scene& scene, const DaylightRequest& request,
                                         std::span<const ViewOut> views, const DaylightArguments& arguments,
                                         const StopRequest& stop) {
    const Result<std::vector<float>> coefficients =
        all_or_none(read_coefficients(arguments.coefficients, request.task));
    if (!coefficients) return coefficients.error();
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    return write_all(request, {unknown, unknown, 0}, views, arguments.output, [&](const DaylightSink& sink) {
        return evaluate_coefficients(scene, request.task, *coefficients, sink, stop);
    });
}

/// Evaluates and writes daylight glare at the views.
Result<GlareSummary> write_year_of_glare(const DaylightSimulation& simulation, const DaylightRequest& request,
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
Result<void> tell_states(const DaylightSimulation& simulation, const DaylightRequest& request,
                         const DaylightArguments& arguments, Terminal& terminal) {
    if (!simulation.states()) return {};
    for (const std::string& warning : simulation.warnings()) terminal.progress().warn(warning);
    return write_states(arguments.output, *request.states, *simulation.states(), request.task.hours);
}

/// Warns of sensors that are probably in the wrong place.
void warn_of_sensors(const DaylightSimulation& simulation, Terminal& terminal) {
    if (!is_first_process()) return;
    for (const std::string& warning : simulation.sensor_warnings()) terminal.progress().warn(warning);
}

/// Evaluates and writes all sensors.
Result<DaylightSummary> run_whole(const Scene& scene, const DaylightRequest& request, std::span<const ViewOut> views,
                                  const DaylightArguments& arguments, const StopRequest& stop, Terminal& terminal) {
    if (!arguments.coefficients.empty()) return run_coefficients(scene, request, views, arguments, stop);
    DaylightSimulation simulation(scene, request.task, terminal.progress(), stop);
    warn_of_sensors(simulation, terminal);
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
        return terminal.fail(Error{ErrorCode::usage, "works in one process only", "--merge", "run it without mpirun"});
    if (!arguments.states.empty() && processes() > 1)
        return terminal.fail(Error{ErrorCode::usage, "states of panes are evaluated by one process", "--states",
                                   "run it without mpirun; --threads uses all cores"});
    set_threads(arguments.threads);
    const Result<SceneWithNames> read = read_daylight_scene(arguments, terminal);
    if (!read) return terminal.fail(read.error());
    const Scene* const scene = &read->scene;
    Result<DaylightRequest> request = all_or_none(read_daylight_request(arguments, *scene, terminal));
    if (!request) return terminal.fail(request.error());
    const Result<void> states = read_daylight_states(arguments, *read, *request);
    if (!states) return terminal.fail(states.error());
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
