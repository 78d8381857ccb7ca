#include "exitance/solve.hpp"

#include <fmt/format.h>

#include <array>

#include "exitance/api/inside.hpp"
#include "exitance/base/memory.hpp"
#include "exitance/error/texture_error.hpp"
#include "exitance/methods/options/make_request.hpp"
#include "exitance/methods/options/solve_option_table.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/methods/run_report.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/what_if/light_groups/keep_light_groups.hpp"

namespace exitance::api {
namespace {

/// Options that have members of their own in SolveOptions, or in the options for loading a scene.
constexpr std::array members{"error", "method", "bounces",      "threads", "memory-limit",
                             "sky",   "epw",    "light-groups", "quantity"};
/// Options of files, and of published forms, which are part of the program only.
constexpr std::array program_only{"importance", "checkpoint-every", "resume",     "dry-run",
                                  "trace",      "recipe",           "task-engine"};

bool contains(std::span<const char* const> names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Appends an option of the table with its word.
Result<void> give(const std::string& name, const std::string& word, std::vector<GivenOption>& given) {
    const OptionRow* const row = find_option("--" + name);
    if (!row) return usage("is not an option of solve", name, "`exitance solve --help-all` lists the options");
    given.push_back({row, word});
    return {};
}

/// The options of a solve in the engine's form. Error (usage): an option is unknown, wrong, or not supported.
Result<SolveRequest> request_of(const SolveOptions& options, bool light_groups) {
    std::vector<GivenOption> given;
    std::vector<std::pair<std::string, std::string>> words{{"method", options.method}};
    if (options.error) words.emplace_back("error", fmt::format("{}", *options.error));
    if (options.bounces >= 0) words.emplace_back("bounces", std::to_string(options.bounces));
    if (options.threads != 0) words.emplace_back("threads", std::to_string(options.threads));
    for (const auto& [name, word] : options.more) {
        if (contains(members, name)) return usage("has an argument of its own", name, "use that argument");
        if (contains(program_only, name))
            return usage("is an option of the program, not of the library", name, "run `exitance solve`");
        words.emplace_back(name, word);
    }
    for (const auto& [name, word] : words)
        if (const Result<void> known = give(name, word, given); !known) return known.error();
    exitance::Result<SolveRequest> request = make_request(given);
    if (!request) return to_api(request.error());
    request->options.memory_limit_bytes = options.memory_limit;
    request->light_groups = light_groups;
    if (form_of(request->options) != Form::standard)
        return usage("the options select a published form, which is part of the program only", "more",
                     "run `exitance solve`");
    if (const exitance::Result<MethodForm> method_form = find_method_form(*request); !method_form)
        return to_api(method_form.error());
    if (options.bounces < -1) return usage("must be -1 (all) or at least 0", "bounces");
    if (options.time_limit && !(*options.time_limit > 0)) return usage("must be above 0 seconds", "time_limit");
    return std::move(*request);
}

/// Records options, findings, time and memory of the run in its solution.
void record_run(const SolveRequest& request, const SceneData& scene, const Stopwatch& watch,
                exitance::Solution& solution) {
    solution.options = recorded_options(request);
    SolveStatistics& statistics = solution.statistics;
    add_findings(statistics.warnings, scene.engine_findings, solution.scene.file());
    statistics.warnings.insert(statistics.warnings.begin(), request.warnings.begin(), request.warnings.end());
    statistics.seconds[RunPart::total] = watch.seconds();
    statistics.peak_memory_bytes = peak_memory_bytes();
}

Result<Solution> solve_request(const SceneData& scene, const SolveRequest& request, Run& run) {
    const Stopwatch watch;
    if (scene.light_groups)
        if (const exitance::Result<void> few = check_light_groups(*scene.scene); !few) return to_api(few.error());
    const ThreadsOfCall threads(request.options.threads);
    exitance::Result<exitance::Solution> solved =
        solve_scene(*scene.scene, request.options, run.progress(), run.stop());
    if (!solved) return to_api(solved.error());
    if (const std::optional<exitance::Error> failed =
            error_of_missing_estimate(solved->statistics, request.options, ""))
        return to_api(*failed);
    add_texture_error(*solved, scene.reflectance_deviation, request.options.error_demand());
    warn_of_useless_light(solved->statistics);
    LightGroups groups;
    if (scene.light_groups) {
        exitance::Result<LightGroups> kept = keep_light_groups(*solved, request.options, run.progress(), run.stop());
        if (!kept) return to_api(kept.error());
        groups = std::move(*kept);
    }
    SolveStatistics& statistics = solved->statistics;
    if (std::optional<std::string> end = message_of_early_end(statistics, request.options)) {
        run.progress().warn(*end);
        statistics.warnings.push_back(std::move(*end));
    }
    record_run(request, scene, watch, *solved);
    auto data = std::make_shared<SolutionData>();
    data->solution = std::move(*solved), data->groups = std::move(groups);
    return Solution(std::move(data));
}

}  // namespace

Result<Solution> solve(const Scene& scene, const SolveOptions& options, const Control& control) {
    return take_turn<Solution>(control, [&](Run& run) -> Result<Solution> {
        const Result<SolveRequest> request = request_of(options, scene.has_light_groups());
        if (!request) return request.error();
        run.limit_time(options.time_limit);
        return solve_request(scene.data(), *request, run);
    });
}

}  // namespace exitance::api
