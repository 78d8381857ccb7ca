#include "exitance/cli/solve/classical_solve.hpp"

#include <fmt/format.h>

#include "exitance/cli/json_output.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/lab/classical/classical.hpp"

namespace exitance {

Result<Solution> run_classical(const SolveArguments& arguments, const Scene& scene, Progress& progress,
                               const StopRequest& stop) {
    const std::string& output = arguments.output;
    const std::string stem = output.ends_with(".h5") ? output.substr(0, output.size() - 3) : output;
    ClassicalFacts facts;
    const auto write = [&](const Solution& on_the_way, std::size_t number) {
        Solution snapshot = on_the_way;
        snapshot.options = options_json(arguments, {});
        return write_solution(fmt::format("{}.{:04}.h5", stem, number), snapshot);
    };
    Result<Solution> solution =
        solve_classical(scene, arguments.options, arguments.classical, progress, stop, facts, write);
    if (solution) solution->options = options_json(arguments, facts);
    return solution;
}

}  // namespace exitance
