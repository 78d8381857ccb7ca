#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "exitance/base/nearest.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/cli/processes.hpp"
#include "exitance/cli/summary.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/lab/study/conduct_study.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/processes/run_apart.hpp"

namespace exitance {
namespace {

/// The study in a file that ends in .toml, or the built-in study of that name.
Result<Study> find_study(const std::string& name) {
    if (name.ends_with(".toml")) return load_study(name);
    std::vector<std::string> names;
    for (const BuiltInStudy& study : built_in_studies()) {
        if (study.name == name) return parse_study(std::string(study.text), name, name + ".toml");
        names.emplace_back(study.name);
    }
    const std::string near = nearest(name, names);
    return Error{ErrorCode::usage, fmt::format("there is no study '{}'", name), "",
                 near.empty() ? fmt::format("studies are {}, or a file that ends in .toml", fmt::join(names, ", "))
                              : fmt::format("did you mean '{}'?", near)};
}

ExitCode list_studies(Terminal& terminal) {
    std::string text;
    for (const BuiltInStudy& built_in : built_in_studies()) {
        const Result<Study> study = parse_study(std::string(built_in.text), std::string(built_in.name), "");
        if (!study) return terminal.fail(study.error());
        text += fmt::format("{:<16} {}\n", built_in.name, study->title);
    }
    terminal.print(text);
    return ExitCode::done;
}

std::string as_text(const StudyReport& report) {
    std::string text = fmt::format("runs       {} of {} done\n", report.runs_done, report.runs);
    for (const Verdict& v : report.verdicts)
        text += fmt::format("{:<10} {}{}\n",
                            v.holds == Verdict::Holds::yes          ? "holds"
                            : v.holds == Verdict::Holds::no         ? "does not"
                            : v.holds == Verdict::Holds::not_judged ? "not judged"
                                                                    : "unknown",
                            v.conclusion->says, v.detail.empty() ? "" : ": " + v.detail);
    return text + fmt::format("page       {}\n", report.page);
}

void show(const StudyReport& report, bool is_quiet, Terminal& terminal) {
    for (const std::string& warning : report.warnings) terminal.note("warning: " + warning);
    if (!is_quiet) terminal.print(as_text(report));
}

/// Deals the runs of a study out to the processes; then the first one makes the page from their records.
ExitCode run_on_processes(const Study& study, const StudyOptions& options, bool is_quiet, Terminal& terminal) {
    RunLimits& limits = terminal.limits();
    const StopRequest& stop = limits.stop();
    hide_launcher();
    const Result<void> shared = run_own_share(study, options, terminal.progress(), stop);
    if (!shared) return terminal.fail(shared.error());
    const bool is_stopped = largest_of_all(stop.requested() ? 1 : 0) > 0;
    Result<void> made;
    if (!is_stopped)
        made = by_first([&]() -> Result<void> {
            const Result<StudyReport> report = conduct_study(study, options, terminal.progress(), stop);
            if (!report) return report.error();
            show(*report, is_quiet, terminal);
            return {};
        });
    terminal.progress().finish();
    if (!made) return terminal.fail(made.error());
    if (!is_stopped) return ExitCode::done;
    terminal.note("stopped: the same command continues from the finished runs");
    return signal_of_any(limits.signal()).value_or(ExitCode::demand_not_reached);
}

}  // namespace

/// Runs `exitance experiment STUDY -o FOLDER`.
ExitCode run(const ExperimentArguments& arguments, Terminal& terminal) {
    if (arguments.study == "list") return list_studies(terminal);
    const Result<Study> study = find_study(arguments.study);
    if (!study) return terminal.fail(study.error());
    if (arguments.print) {
        terminal.print(study->text);
        return ExitCode::done;
    }
    if (arguments.output.empty())
        return terminal.fail({ErrorCode::usage, "is missing", "-o", "exitance experiment blocker -o blocker"});
    set_threads(arguments.threads);
    RunLimits& limits = terminal.limits();
    const StopRequest& stop = limits.keep();
    std::error_code failed;
    const std::string program = std::filesystem::read_symlink("/proc/self/exe", failed).string();
    const StudyOptions options{arguments.output, program, arguments.quick, arguments.methods, arguments.threads};
    if (processes() > 1) return run_on_processes(*study, options, arguments.quiet, terminal);
    const Result<StudyReport> report = conduct_study(*study, options, terminal.progress(), stop);
    terminal.progress().finish();
    if (!report && limits.signal()) return *limits.signal();
    if (!report) return terminal.fail(report.error());
    show(*report, arguments.quiet, terminal);
    if (limits.signal()) return *limits.signal();
    if (!stop.requested()) return ExitCode::done;
    terminal.note(
        fmt::format("stopped by the {}: the same command continues from the finished runs", name_of(limits.reason())));
    return ExitCode::demand_not_reached;
}

}  // namespace exitance
