#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <utility>

#include "exitance/base/memory.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/cli/common_stop.hpp"
#include "exitance/cli/json_output.hpp"
#include "exitance/cli/processes.hpp"
#include "exitance/cli/solve/settle_options.hpp"
#include "exitance/cli/summary.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/error/texture_error.hpp"
#include "exitance/io/files/trace_file.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/io/solution/checkpoint_file.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/io/solution/statistics_json.hpp"
#include "exitance/io/solution/stored_scene_check.hpp"
#include "exitance/methods/plan/forecast.hpp"
#include "exitance/methods/run_report.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/what_if/light_groups/keep_light_groups.hpp"

namespace exitance {
namespace {

/// Seconds left for the solve: the time left, minus the time to write the solution, estimated from `read_seconds`.
double time_to_solve(const SolveArguments& arguments, const RunLimits& limits, double read_seconds) {
    // Time for error estimate, exported mesh and file, divided by the time to read the scene; measured 8.5 with 54,005
    // polygons.
    constexpr double written_against_read = 8;
    return limits.seconds_left() - std::min(0.5 * *arguments.limits.time_limit, written_against_read * read_seconds);
}

/// Runs `exitance solve SCENE --dry-run`.
ExitCode show_forecast(const SolveArguments& arguments, const Scene& scene, Terminal& terminal) {
    const Result<Forecast> forecast = forecast_solve(scene, arguments.options);
    if (!forecast) return terminal.fail(forecast.error());
    terminal.print(arguments.json ? forecast_json(*forecast) : summary(*forecast));
    return ExitCode::done;
}

/// Records the trace of a run during its lifetime, if a file for it was given.
class Tracing {
  public:
    Tracing(const std::string& path, Progress& inner) : path_(path), inner_(inner) {
        if (path.empty()) return;
        trace_.emplace();
        progress_.emplace(inner, *trace_);
        set_task_trace(&*trace_);
    }
    ~Tracing() { set_task_trace(nullptr); }
    Tracing(const Tracing&) = delete;
    Tracing& operator=(const Tracing&) = delete;

    Progress& progress() { return progress_ ? *progress_ : inner_; }
    Result<void> write() {
        if (!trace_) return {};
        set_task_trace(nullptr);
        trace_->finish();
        return write_trace(*trace_, path_);
    }

  private:
    std::string path_;
    Progress& inner_;
    std::optional<TaskTrace> trace_;
    std::optional<TracedProgress> progress_;
};

/// Calls RunLimits::keep() when the first phase of a solve begins. Before it, only the structures for rays and contacts
/// are built: there is nothing to keep, and limits and signals end the program.
class KeptFromFirstPhase : public Progress {
  public:
    KeptFromFirstPhase(RunLimits& limits, Progress& inner) : limits_(limits), inner_(inner) {}

    void phase(std::string_view name) override {
        limits_.keep();
        inner_.phase(name);
    }
    void advance(double fraction, std::string_view detail) override { inner_.advance(fraction, detail); }
    void note(std::string_view message) override { inner_.note(message); }
    void warn(std::string_view message) override { inner_.warn(message); }

  private:
    RunLimits& limits_;
    Progress& inner_;
};

/// Everything that a solution depends on: bands, scene and options, as names and values.
CheckpointFacts facts_of(const SolveArguments& arguments, const Scene& scene) {
    CheckpointFacts facts{{"bands", std::to_string(bands)}, {"the scene", scene_fingerprint(scene)}};
    for (auto& [name, value] : option_facts(arguments)) facts.emplace_back("--" + name, value);
    for (auto& fact : facts) std::replace(fact.first.begin(), fact.first.end(), '_', '-');
    return facts;
}

/// Opens OUTPUT.checkpoint as `file` if checkpoints are written or resumed from, and loads it for --resume. Otherwise
/// `file` stays empty.
Result<void> open_checkpoint(const SolveArguments& arguments, const Scene& scene, Terminal& terminal,
                             std::optional<CheckpointFile>& file) {
    if (!arguments.checkpoint_every && !arguments.resume) return {};
    const std::string path = arguments.output + ".checkpoint";
    file.emplace(path, facts_of(arguments, scene),
                 arguments.checkpoint_every.value_or(std::numeric_limits<double>::infinity()));
    if (!arguments.resume) return {};
    const Result<bool> loaded = file->load();
    if (!loaded) return loaded.error();
    terminal.note(*loaded ? "continuing from " + path : "there is no " + path + ": starting from the beginning");
    return {};
}

/// Frees most memory of a solution that has been written. Keeps the members that are printed, such as statistics, their
/// unit and options.
void drop_light(Solution& solution) {
    const bool photometric = solution.scene.is_photometric();
    solution.scene = {};
    solution.scene.declare_photometric(photometric);
    solution.indirect = {}, solution.interpolant = {};
    solution.links = {}, solution.discontinuity = {}, solution.layers = {}, solution.own_form = {},
    solution.delivers_own_form = false;
    release_freed_memory();
}

/// Writes the solution. If `reads_back` is set and the output is a regular file (unlike /dev/null), frees the light in
/// memory and reads the file back to verify it.
Result<void> write_checked(const std::string& path, Solution& solution, const LightGroups& groups, VtkGroup vtk,
                           bool reads_back) {
    if (const Result<void> written = write_solution(path, solution, &groups, vtk);
        !written || !reads_back || !std::filesystem::is_regular_file(path))
        return written;
    drop_light(solution);
    LightGroups groups_again;
    if (const Result<Solution> read_back = load_solution(path, Rehearsed::already, &groups_again); !read_back)
        return Error{ErrorCode::failure, "was written, but cannot be read: " + read_back.error().message, path,
                     "please report the scene"};
    return {};
}

/// Removes the checkpoint unless the solve was stopped. Prints a note if the checkpoint could not be written.
void close_checkpoint(const std::optional<CheckpointFile>& file, bool stopped, Terminal& terminal) {
    if (!file) return;
    if (!file->written()) terminal.note("no checkpoint: " + file->written().error().message);
    if (!stopped) file->remove();
}

ExitCode code_of(const SolveStatistics& statistics, const RunLimits& limits) {
    if (const std::optional<ExitCode> signal = limits.signal()) return *signal;
    return statistics.converged ? ExitCode::done : ExitCode::demand_not_reached;
}

/// Reads the scene with the options of the solve. Programs that generate parts of it are ended at the time limit.
LoadedScene read_scene(SolveArguments& arguments, const StopRequest& stop) {
    LoadOptions& load = arguments.scene.load;
    load.stop = &stop;
    load.photometric = arguments.photometric;
    load.light_groups = arguments.light_groups;
    LoadedScene checked = load_for_all(arguments.scene);
    load.stop = nullptr;
    return checked;
}

/// Error for a scene whose solution could not be read back.
Result<void> check_scene(const SolveArguments& arguments, const Scene& scene) {
    if (const auto nonsense = find_nonsense(scene))
        return Error{ErrorCode::failure, "makes a scene whose solution could not be read: " + *nonsense,
                     arguments.scene.files[0], "please report this file"};
    return {};
}

/// Computes the light. Writes requested snapshots as STEM.0001.h5, ... for an output STEM.h5.
Result<Solution> find_light(const SolveArguments& arguments, Scene scene, std::optional<CheckpointFile>& checkpoint,
                            Progress& progress, const StopRequest& stop) {
    const std::string& output = arguments.output;
    const std::string stem = output.ends_with(".h5") ? output.substr(0, output.size() - 3) : output;
    Result<void> written;
    const auto write = [&, number = 0](Solution snapshot) mutable {
        snapshot.options = options_json(arguments);
        if (written) written = write_solution(fmt::format("{}.{:04}.h5", stem, ++number), snapshot);
    };
    Result<Solution> solution =
        solve_scene(std::move(scene), arguments.options, progress, stop, checkpoint ? &*checkpoint : nullptr,
                    arguments.options.snapshots.any() ? ShowLight(write) : ShowLight());
    return written ? std::move(solution) : Result<Solution>(written.error());
}

/// Records options, findings, times and memory of the run so far in the solution.
void record_run(Solution& solution, const SolveArguments& arguments, const std::vector<Finding>& findings,
                double read_seconds, const Stopwatch& run_time) {
    SolveStatistics& statistics = solution.statistics;
    solution.options = with_scene_options(options_json(arguments), arguments.scene.load);
    add_findings(statistics.warnings, findings, solution.scene.file());
    statistics.seconds[RunPart::read] = read_seconds;
    statistics.seconds[RunPart::total] = run_time.seconds();
    statistics.peak_memory_bytes = peak_memory_bytes();
    record_processes(statistics);
}

/// Writes the solution and records the time for it. The file is read back unless `stop` was requested. Collective.
Result<void> save(const SolveArguments& arguments, Solution& solution, const LightGroups& groups, Tracing& tracing,
                  const StopRequest& stop, const Stopwatch& run_time) {
    tracing.progress().phase("write");
    Stopwatch writing;
    if (!is_first_process()) drop_light(solution);
    const bool reads_back = !stop.requested();
    const VtkGroup vtk = arguments.vtkhdf ? VtkGroup::written : VtkGroup::left_out;
    if (const Result<void> written =
            by_first([&] { return write_checked(arguments.output, solution, groups, vtk, reads_back); });
        !written)
        return written;
    SolveStatistics& statistics = solution.statistics;
    statistics.seconds[RunPart::write] = writing.seconds();
    if (processes() > 1) record_processor_time(statistics);
    statistics.seconds[RunPart::total] = run_time.seconds();
    statistics.peak_memory_bytes = std::max(statistics.peak_memory_bytes, peak_memory_bytes());
    return {};
}

/// Prints the warnings about the options, and sets threads and schedule.
void begin(const SolveArguments& arguments, Terminal& terminal) {
    for (const std::string& warning : arguments.warnings) terminal.progress().warn(warning);
    if (arguments.scene.load.sky)
        for (const std::string& warning : arguments.scene.load.sky->warnings) terminal.progress().warn(warning);
    set_threads(arguments.options.threads);
    set_schedule(arguments.options.schedule);
}

/// Ends a run whose solution has no estimate of its error. The checkpoint is kept.
ExitCode fail_without_estimate(const Error& error, const std::optional<CheckpointFile>& checkpoint,
                               std::optional<ExitCode> signal, Terminal& terminal) {
    terminal.progress().finish();
    close_checkpoint(checkpoint, true, terminal);
    const ExitCode failure = terminal.fail(error);
    return signal ? *signal : failure;
}

void print_result(const SolveArguments& arguments, const Solution& solution, Terminal& terminal) {
    if (arguments.json) {
        terminal.print(statistics_json(solution));
    } else if (!arguments.quiet) {
        terminal.print(summary(solution));
    }
}

}  // namespace

/// Runs `exitance solve SCENE -o SOLUTION`.
ExitCode run(const SolveArguments& given, Terminal& terminal) {
    const Stopwatch run_time;
    RunLimits& limits = terminal.limits();
    SolveArguments arguments = given;
    if (const Result<void> settled = settle_options(arguments); !settled) return terminal.fail(settled.error());
    begin(arguments, terminal);
    Tracing tracing(arguments.trace, terminal.progress());

    const Stopwatch reading;
    LoadedScene checked = read_scene(arguments, limits.stop());
    terminal.show(checked.findings);
    if (!checked.scene) return terminal.fail(checked);
    if (arguments.light_groups)
        if (const Result<void> few = check_light_groups(*checked.scene); !few) return terminal.fail(few.error());
    const double read_seconds = reading.seconds();
    if (arguments.dry_run) return show_forecast(arguments, *checked.scene, terminal);
    if (const Result<void> sane = check_scene(arguments, *checked.scene); !sane) return terminal.fail(sane.error());
    if (arguments.photometric) checked.scene->declare_photometric(*arguments.photometric);

    CommonStop common(terminal, limits.stop(), CommonStop::MemoryLimit::fitted);
    const StopRequest& stop = common.request();
    if (arguments.limits.time_limit)
        common.set_deadline(seconds_from_now(time_to_solve(arguments, limits, read_seconds)));
    std::optional<CheckpointFile> checkpoint;
    if (const Result<void> opened = open_checkpoint(arguments, *checked.scene, terminal, checkpoint); !opened)
        return terminal.fail(opened.error());
    KeptFromFirstPhase progress(limits, tracing.progress());
    Result<Solution> solution = find_light(arguments, std::move(*checked.scene), checkpoint, progress, stop);
    limits.keep();
    const bool stopped = stop.requested() || (solution && solution->statistics.stopped_by == StopReason::time_limit);
    const std::optional<ExitCode> signal = common.signal();
    if (!solution && signal) return *signal;
    if (!solution) return terminal.fail(solution.error());

    if (const std::optional<Error> failed =
            error_of_missing_estimate(solution->statistics, arguments.options, arguments.output))
        return fail_without_estimate(*failed, checkpoint, signal, terminal);
    add_texture_error(*solution, checked.reflectance_deviation, arguments.options.error_demand());
    warn_of_useless_light(solution->statistics);
    const Result<LightGroups> groups = arguments.light_groups
                                           ? keep_light_groups(*solution, arguments.options, tracing.progress(), stop)
                                           : LightGroups();
    if (!groups) return terminal.fail(groups.error());
    record_run(*solution, arguments, checked.findings, read_seconds, run_time);
    SolveStatistics& statistics = solution->statistics;
    if (std::optional<std::string> end = message_of_early_end(statistics, arguments.options)) {
        terminal.progress().warn(*end);
        statistics.warnings.push_back(std::move(*end));
    }
    if (const Result<void> saved = save(arguments, *solution, *groups, tracing, stop, run_time); !saved)
        return terminal.fail(saved.error());
    terminal.progress().finish();
    close_checkpoint(checkpoint, stopped, terminal);
    if (const Result<void> written = tracing.write(); !written) return terminal.fail(written.error());
    print_result(arguments, *solution, terminal);
    return signal ? *signal : as_first(code_of(statistics, limits));
}

}  // namespace exitance
