#include "exitance/cli/solve/task_engine_check.hpp"

#include "exitance/cli/solve/disobeyed.hpp"

namespace exitance {

Result<void> check_task_engine(const SolveArguments& arguments) {
    const SolveOptions& o = arguments.options;
    if (!o.task_engine) return {};
    if (arguments.classical.any())
        return Error{ErrorCode::usage, "is a classical form of its own: of their options it takes --threshold alone",
                     "--task-engine", "leave --task-engine or the others out"};
    if (o.method != Method::hierarchical)
        return Error{ErrorCode::usage, "is a form of --method hierarchical", "--task-engine",
                     "exitance solve SCENE -o S.h5 --method hierarchical --task-engine"};
    std::vector<GivenOption> disobeyed = options_of_methods(arguments);
    disobeyed.insert(disobeyed.end(), {{"--error", o.error.has_value()},
                                       {"--error-interpolant", o.error_interpolant.has_value()},
                                       {"--clusters", o.clusters == true}});
    return refuse_given(disobeyed, "--task-engine", "without --task-engine, --method hierarchical obeys it");
}

}  // namespace exitance
