#include "exitance/cli/solve/local_pass_check.hpp"

#include "exitance/cli/solve/disobeyed.hpp"

namespace exitance {

Result<void> check_local_pass(const SolveArguments& arguments) {
    const SolveOptions& o = arguments.options;
    if (o.local_pass.value_or(LocalPassRule::e) == LocalPassRule::e) return {};
    std::vector<GivenOption> disobeyed = options_of_methods(arguments);
    disobeyed.insert(disobeyed.end(), {
                                          {"--min-area", o.min_area.has_value()},
                                          {"--residual", o.residual.has_value()},
                                          {"--max-iterations", o.max_iterations.has_value()},
                                          {"--triage", !o.triage},
                                          {"--clusters", o.clusters.has_value()},
                                          {"--smoothing", o.smoothing.has_value()},
                                          {"--oracle", o.oracle != LinkOracle::transport},
                                          {"a classical form", arguments.classical.any()},
                                      });
    return refuse_given(disobeyed, "--local-pass a to d", "leave it out, or leave out --local-pass");
}

}  // namespace exitance
