#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "exitance/cli/verbs.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/files/write_error.hpp"
#include "exitance/sweep/plan_warnings.hpp"
#include "exitance/sweep/run_sweep.hpp"
#include "exitance/sweep/sweep_json.hpp"
#include "exitance/sweep/sweep_plan.hpp"
#include "exitance/sweep/sweep_results.hpp"

namespace exitance {
namespace {

/// Parses the commands of the first variant, so that a wrong verb or option is reported before anything is run. Error:
/// bad_input, with the line of the plan.
Result<void> check_commands(const SweepPlan& plan) {
    for (const SweepStep& step : plan.steps) {
        const Result<std::vector<std::string>> words = fill_in(plan, step.words, plan.variants.front(), step.line);
        if (!words) return words.error();
        const std::string where = fmt::format("{}:{}", plan.path, step.line);
        const std::string& verb = words->front();
        if (verb == "sweep" || verb == "view")
            return Error{ErrorCode::bad_input,
                         fmt::format("'run' of step '{}': '{}' cannot be a step", step.name, verb), where,
                         "steps are verbs that end by themselves, such as solve, mix, probe"};
        const auto parsed = parse_arguments(*words);
        if (parsed) continue;
        const Error& error = parsed.error();
        return Error{ErrorCode::bad_input,
                     fmt::format("'run' of step '{}': {}{}{}", step.name, error.where, error.where.empty() ? "" : ": ",
                                 error.message),
                     where, error.hint};
    }
    return {};
}

/// Shows the first 20 warnings. `others` describes the rest, after its number.
void show_warnings(const std::vector<std::string>& warnings, std::string_view others, Terminal& terminal) {
    constexpr std::size_t max_warnings = 20;
    for (std::size_t i = 0; i < std::min(max_warnings, warnings.size()); ++i)
        terminal.note(fmt::format("warning: {}", warnings[i]));
    if (warnings.size() > max_warnings)
        terminal.note(fmt::format("warning: {} more {}", warnings.size() - max_warnings, others));
}

StepRunner runner_for(const SweepPlan& plan, const SweepArguments& arguments) {
    std::error_code failed;
    StepRunner runner{
        std::filesystem::read_symlink("/proc/self/exe", failed).string(), plan.base, {}, arguments.threads};
    for (const VerbFacts& verb : facts_of_verbs())
        if (std::any_of(verb.options.begin(), verb.options.end(),
                        [](const OptionFacts& option) { return option.long_name == "--threads"; }))
            runner.threaded.insert(verb.name);
    const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    if (runner.threads == 0 && arguments.local > 0)
        runner.threads = std::max(1, cores / static_cast<int>(arguments.local));
    return runner;
}

/// The table of `--list`.
std::string as_text(const SweepPlan& plan, const std::vector<VariantState>& states) {
    std::vector<std::vector<std::string>> rows{{"variant", "state"}};
    rows[0].insert(rows[0].end(), plan.parameters.begin(), plan.parameters.end());
    for (std::size_t i = 0; i < states.size(); ++i) {
        std::vector<std::string>& row = rows.emplace_back();
        row = {std::to_string(i + 1), name_of(states[i].kind)};
        for (const auto& [name, value] : plan.variants[i]) row.push_back(text_of(value));
    }
    std::vector<std::size_t> widths(rows[0].size());
    for (const std::vector<std::string>& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    std::string text;
    for (const std::vector<std::string>& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) line += fmt::format("{:<{}}  ", row[i], widths[i]);
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    for (std::size_t i = 0; i < states.size(); ++i)
        if (!states[i].failure.empty()) text += fmt::format("variant {}: {}\n", i + 1, states[i].failure);
    return text;
}

ExitCode list_variants(const SweepPlan& plan, const SweepArguments& arguments, Terminal& terminal) {
    const Result<std::vector<VariantState>> states = sweep_states(plan);
    if (!states) return terminal.fail(states.error());
    terminal.print(arguments.json ? sweep_json(plan, *states) : as_text(plan, *states));
    return ExitCode::done;
}

/// Runs the requested variants. Status 1 if one of `--run` fails, 4 if some of `--local` fail.
ExitCode run_variants(const SweepPlan& plan, const SweepArguments& arguments, Terminal& terminal) {
    std::vector<std::size_t> variants;
    for (std::size_t i = 0; i < plan.variants.size(); ++i)
        if (!arguments.run || (i + 1 >= arguments.run->first && i + 1 <= arguments.run->last)) variants.push_back(i);
    if (arguments.run && arguments.run->last > plan.variants.size())
        return terminal.fail({ErrorCode::usage, fmt::format("there are {} variants", plan.variants.size()), "--run",
                              "--list numbers them from 1"});
    RunLimits& limits = terminal.limits();
    const StopRequest& stop = limits.keep();
    const int jobs = static_cast<int>(std::min(std::max<std::size_t>(1, arguments.local), variants.size()));
    const Result<SweepReport> report =
        run_sweep(plan, variants, jobs, runner_for(plan, arguments), terminal.progress(), stop);
    terminal.progress().finish();
    if (!report && limits.signal()) return *limits.signal();
    if (!report) return terminal.fail(report.error());
    show_warnings(report->warnings, "results were damaged", terminal);
    for (const std::string& failure : report->failures) terminal.fail({ErrorCode::failure, failure, "", ""});
    if (arguments.json)
        terminal.print(sweep_report_json(*report));
    else
        terminal.note(fmt::format("{} of {} variants done; {} steps run, {} reused", report->done, report->variants,
                                  report->steps_run, report->steps_reused));
    if (stop.requested() && report->done + report->failures.size() < report->variants) {
        terminal.note(fmt::format("stopped by the {}: the same command continues", name_of(limits.reason())));
        return limits.stopped_code();
    }
    if (report->failures.empty()) return ExitCode::done;
    return arguments.run ? ExitCode::failure : ExitCode::demand_not_reached;
}

/// Writes the table of results. Status 4 if variants or values are missing.
ExitCode collect(const SweepPlan& plan, const SweepArguments& arguments, Terminal& terminal) {
    const Result<std::vector<VariantState>> states = sweep_states(plan);
    if (!states) return terminal.fail(states.error());
    if (const Result<void> updated = update_variant_folders(plan, *states); !updated)
        terminal.note(fmt::format("warning: {}: {}", updated.error().where, updated.error().message));
    const SweepResults results = collect_results(plan, *states);
    std::vector<std::string> outputs = arguments.outputs;
    std::error_code failed;
    if (outputs.empty()) {
        std::filesystem::create_directories(plan.folder, failed);
        if (failed) return terminal.fail(cannot_write(plan.folder, failed.value()));
        for (const char* const name : {"results.csv", "results.h5"})
            outputs.push_back((std::filesystem::path(plan.folder) / name).string());
    }
    for (const std::string& output : outputs) {
        const Result<void> written =
            ending(output) == ".h5" ? write_results_hdf5(results, plan, output) : write_results_csv(results, output);
        if (!written) return terminal.fail(written.error());
        terminal.note(fmt::format("{}: {} variants", output, results.rows));
    }
    show_warnings(results.problems, "values are missing", terminal);
    return results.problems.empty() ? ExitCode::done : ExitCode::demand_not_reached;
}

Result<void> check_outputs(const SweepArguments& arguments) {
    if (!arguments.outputs.empty() && !arguments.collect)
        return Error{ErrorCode::usage, "has no effect without --collect", "-o",
                     "leave one of the two out, or add --collect"};
    for (const std::string& output : arguments.outputs)
        if (ending(output) != ".csv" && ending(output) != ".h5")
            return Error{ErrorCode::usage, "tables of results are written as .csv or .h5", output,
                         "choose another ending"};
    return {};
}

}  // namespace

/// Runs `exitance sweep PLAN --list|--run K|--local N|--collect`.
ExitCode run(const SweepArguments& arguments, Terminal& terminal) {
    const bool runs = arguments.run || arguments.local > 0;
    if (!arguments.list && !runs && !arguments.collect)
        return terminal.fail({ErrorCode::usage, "one of --list, --run, --local and --collect is missing", "",
                              "exitance sweep plan.toml --list"});
    if (arguments.list && (runs || arguments.collect))
        return terminal.fail({ErrorCode::usage, "cannot be combined with --run, --local and --collect", "--list", ""});
    if (const Result<void> checked = check_outputs(arguments); !checked) return terminal.fail(checked.error());
    const Result<SweepPlan> plan = load_sweep_plan(arguments.plan);
    if (!plan) return terminal.fail(plan.error());
    if (const Result<void> checked = check_commands(*plan); !checked) return terminal.fail(checked.error());
    const Result<std::vector<std::string>> warnings = plan_warnings(*plan);
    if (!warnings) return terminal.fail(warnings.error());
    show_warnings(*warnings, "likely mistakes are in the plan", terminal);
    if (arguments.list) return list_variants(*plan, arguments, terminal);
    const ExitCode code = runs ? run_variants(*plan, arguments, terminal) : ExitCode::done;
    const bool is_stopped = terminal.limits().signal().has_value() || terminal.limits().stop().requested();
    if (!arguments.collect || is_stopped || (code != ExitCode::done && code != ExitCode::demand_not_reached))
        return code;
    const ExitCode collected = collect(*plan, arguments, terminal);
    return collected == ExitCode::done ? code : collected;
}

}  // namespace exitance
