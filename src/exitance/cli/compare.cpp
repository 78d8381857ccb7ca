#include <fmt/format.h>

#include "exitance/cli/json_output.hpp"
#include "exitance/cli/summary.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/io/files/probe_file.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/reconstruct/error/area_samples.hpp"
#include "exitance/reconstruct/error/compare.hpp"
#include "exitance/reconstruct/radiosity_function.hpp"

namespace exitance {
namespace {

constexpr std::size_t points_between_solutions = 20'000;

/// What a solution is held against.
struct Reference {
    std::vector<ProbePoint> points;
    std::vector<Spectrum> irradiance, standard_errors;
};

std::vector<Spectrum> irradiance_at(const Solution& solution, const std::vector<ProbePoint>& points) {
    std::vector<Spectrum> out;
    out.reserve(points.size());
    for (const Light& light : RadiosityFunction(solution).at(points)) out.push_back(light.irradiance);
    return out;
}

Result<Reference> reference_of_probes(const std::string& path) {
    Result<ProbeReference> probes = load_probe_reference(path);
    if (!probes) return probes.error();
    Reference out{{}, std::move(probes->irradiance), std::move(probes->standard_errors)};
    for (std::size_t i = 0; i < probes->probes.size(); ++i)
        out.points.push_back({probes->probes.points[i], probes->probes.normals[i]});
    return out;
}

/// Another solution, at points that are uniform in area over the scene of the first.
Result<Reference> reference_of_solution(const std::string& path, const Scene& scene) {
    const Result<Solution> solution = load_solution(path);
    if (!solution) return solution.error();
    Reference out{points_uniform_in_area(scene, points_between_solutions, 1), {}, {}};
    out.irradiance = irradiance_at(*solution, out.points);
    return out;
}

std::string report(const ErrorMeasure& error) {
    return fmt::format(
        "relative RMS error  {} of {} at {} points\n"
        "with its noise      {} (the reference's noise is {})\n"
        "bias                {:+.3g}%\n"
        "error of a point    {} in the median, {} at most for 95 of 100\n",
        percent(error.relative_rms_error), error.of_irradiance ? "irradiance" : "radiosity", error.points,
        percent(error.raw_relative_rms_error), percent(error.reference_noise), 100 * error.bias,
        percent(error.median_relative_error), percent(error.p95_relative_error));
}

}  // namespace

/// exitance compare SOLUTION REFERENCE
ExitCode run(const CompareArguments& arguments, Terminal& terminal) {
    set_threads(arguments.threads);
    const Result<Solution> solution = load_solution(arguments.solution);
    if (!solution) return terminal.fail(solution.error());
    const Result<Reference> reference = arguments.reference.ends_with(".h5")
                                            ? reference_of_solution(arguments.reference, solution->scene)
                                            : reference_of_probes(arguments.reference);
    if (!reference) return terminal.fail(reference.error());

    const Locator locator(solution->scene);
    std::vector<SurfaceId> surfaces;
    for (const ProbePoint& point : reference->points) surfaces.push_back(locator.find(point.x, point.n));
    const std::vector<Spectrum> irradiance = irradiance_at(*solution, reference->points);
    const ErrorMeasure error =
        measure_error({irradiance, reference->irradiance, reference->standard_errors, surfaces}, solution->scene);
    terminal.print(arguments.json ? error_json(error) : report(error));
    return ExitCode::done;
}

}  // namespace exitance
