#include "exitance/cli/view/view_solve.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/base/distinct_numbers.hpp"
#include "exitance/cli/json_output.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/what_if/light_groups/keep_light_groups.hpp"

namespace exitance {

ViewSolve::ViewSolve(const ViewArguments& arguments, Scene scene, Gallery& gallery, ViewChanges& changes,
                     Terminal& terminal)
    : arguments_(arguments),
      scene_(std::move(scene)),
      gallery_(gallery),
      changes_(changes),
      progress_(events_, terminal.progress()),
      limits_(terminal.limits()) {}

void ViewSolve::serve(ViewServer& server) {
    server.events("/data/events", [this](std::size_t& next, std::string& text) { return events_.wait(next, text); });
    server.post("/data/stop", [this](const ViewServer::Parameters&) {
        limits_.stop().interrupt();
        return ViewAnswer{200, "text/plain", "stopping"};
    });
    server.post("/data/save", [this](const ViewServer::Parameters&) { return save(); });
}

void ViewSolve::run() {
    SolveRequest request = arguments_.request;
    SolveOptions& options = request.options;
    options.error = arguments_.error;
    options.memory_limit_bytes = arguments_.limits.memory_limit;
    const auto show = [&](Solution solution) {
        solution.options = with_scene_options(options_json(request), arguments_.scene.load);
        const std::size_t count = gallery_.add(std::move(solution));
        events_.tell("light", fmt::format(R"({{"count": {}}})", count));
    };
    Result<Solution> solution = solve_scene(std::move(scene_), options, progress_, limits_.stop(), nullptr, show);
    if (solution && request.light_groups) {
        Result<LightGroups> groups = keep_light_groups(*solution, options, progress_, limits_.stop());
        if (groups)
            changes_.set_groups(std::move(*groups));
        else
            solution = groups.error();
    }
    std::string message = solution ? describe_end(solution->statistics) : solution.error().message;
    // A solve that was stopped before its first estimate returns no better light than the shown one.
    if (solution && (solution->statistics.relative_error_estimate || !gallery_.newest())) show(std::move(*solution));
    std::replace_if(
        message.begin(), message.end(), [](char c) { return c == '"' || c == '\\' || (c >= 0 && c < ' '); }, '\'');
    events_.end(fmt::format(R"({{"message": "{}"}})", message));
}

/// Returns text such as "reached: estimated error 1.8%, 2% requested" or "stopped by the time limit: ...".
std::string ViewSolve::describe_end(const SolveStatistics& statistics) const {
    const std::optional<double>& estimate = statistics.relative_error_estimate;
    const NumberTexts percents = distinct_percents(estimate.value_or(arguments_.error), arguments_.error, 2);
    const std::string error = estimate ? fmt::format("estimated error {}%", percents.first) : "the error is not known";
    const StopReason why = statistics.stopped_by == StopReason::interrupt ? limits_.reason() : statistics.stopped_by;
    const bool is_signal = why == StopReason::interrupt || why == StopReason::termination;
    const std::string end = statistics.converged            ? "reached"
                            : is_signal                     ? "stopped"
                            : why == StopReason::iterations ? "not reached"
                                                            : fmt::format("stopped by the {}", name_of(why));
    return fmt::format("{}: {}, {}% requested", end, error, percents.second);
}

ViewAnswer ViewSolve::save() {
    const Viewed* viewed = gallery_.newest();
    if (!viewed) return {200, "text/plain", "there is no light yet"};
    const LightGroups groups = changes_.groups();
    const Result<void> written = write_solution(arguments_.save, viewed->solution, &groups);
    if (!written) return {500, "text/plain", written.error().message};
    return {200, "text/plain", "saved as " + arguments_.save};
}

}  // namespace exitance
