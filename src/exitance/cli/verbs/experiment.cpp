#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "exitance/base/nearest.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/cli/summary.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/lab/study/conduct_study.hpp"

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
    const Result<StudyReport> report =
        conduct_study(*study, {arguments.output, program, arguments.quick, arguments.methods, arguments.threads},
                      terminal.progress(), stop);
    terminal.progress().finish();
    if (!report && limits.signal()) return *limits.signal();
    if (!report) return terminal.fail(report.error());
    for (const std::string& warning : report->warnings) terminal.note("warning: " + warning);
    if (!arguments.quiet) terminal.print(as_text(*report));
    if (limits.signal()) return *limits.signal();
    if (!stop.requested()) return ExitCode::done;
    terminal.note(fmt::format("stopped by the {}: the same command continues from the finished runs", limits.reason()));
    return ExitCode::demand_not_reached;
}

}  // namespace exitance
