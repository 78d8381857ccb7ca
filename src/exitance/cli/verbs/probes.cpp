#include <fmt/format.h>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/io/solution/solution_file.hpp"

namespace exitance {

/// Runs `exitance probes SOLUTION -o PROBES`.
ExitCode run(const LightProbeArguments& arguments, Terminal& terminal) {
    set_threads(arguments.threads);
    if (arguments.grid.has_value() == !arguments.points.empty())
        return terminal.fail(Error{ErrorCode::usage, "needs either --grid or --points", "probes",
                                   "give the places of the probes by one of them"});
    const Result<Solution> solution = load_solution(arguments.solution);
    if (!solution) return terminal.fail(solution.error());
    Result<std::vector<Point>> points = arguments.grid ? arguments.grid->points() : load_points(arguments.points);
    if (!points) return terminal.fail(points.error());
    const Stopwatch watch;
    const RadiosityFunction light(*solution);
    const StopRequest& stop = terminal.limits().keep();
    const std::vector<LightProbe> probes = light_probes(light, *points, arguments.rays, terminal.progress(), stop);
    terminal.progress().finish();
    if (probes.size() < points->size()) return terminal.fail_stopped("the light probes are not finished");
    const LightProbeTable table{*points, probes, arguments.grid, arguments.rays, solution->scene.is_photometric()};
    const Result<void> written = write_light_probes(arguments.output, table);
    if (!written) return terminal.fail(written.error());
    constexpr double inside = 0.5;  // share of back faces among the directions above which a probe is inside a body
    const auto buried =
        std::count_if(probes.begin(), probes.end(), [](const LightProbe& probe) { return probe.back_share > inside; });
    terminal.note(
        fmt::format("{} probes, {} of them inside of bodies; {:.1f} s", probes.size(), buried, watch.seconds()));
    return ExitCode::done;
}

}  // namespace exitance
