#include <fmt/format.h>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/camera_choice.hpp"
#include "exitance/cli/json_output.hpp"
#include "exitance/cli/summary.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/error/area_samples.hpp"
#include "exitance/io/files/reference_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/pictures/false_colour.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/measure/pictures/error_picture.hpp"

namespace exitance {
namespace {

constexpr std::size_t points_between_solutions = 20'000;

/// Irradiance of the solution in file `path` at points that are uniform in area over `scene`.
Result<ReferencePoints> reference_of_solution(const std::string& path, const Scene& scene) {
    const Result<Solution> solution = load_solution(path);
    if (!solution) return solution.error();
    ReferencePoints out{points_uniform_in_area(scene, points_between_solutions, 1), {}, {}};
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

/// Writes the picture of the error in false colours.
Result<void> write_map(const CompareArguments& arguments, const Solution& solution, const ReferencePoints& reference) {
    const RadiosityFunction light(solution);
    const Result<Camera> camera = choose_camera(arguments.view, light);
    if (!camera) return camera.error();
    const Scene& scene = solution.scene;
    const SeenPlaces places = seen_places(scene, light.stage().tracer, *camera, arguments.view.size);
    std::vector<Spectrum> known;
    if (arguments.reference.ends_with(".h5")) {
        const Result<Solution> other = load_solution(arguments.reference);
        if (!other) return other.error();
        known = irradiance_at(*other, places.points);
    } else {
        known = nearest_reference(places, reference, scene);
    }
    const Evaluated what = arguments.interpolant ? Evaluated::interpolant : Evaluated::function;
    const Picture picture = error_picture(places, irradiance_at(solution, places.points, what), known);
    const ColourScale scale = make_colour_scale(picture, Quantity::irradiance, arguments.view.scale);
    Image image = false_colour_image(picture, Quantity::irradiance, scale);
    draw_legend(image, "error of irradiance, W/m2", scale);
    return write_png(arguments.map, image, {{"Software", "exitance"}, {"Camera", describe(*camera)}});
}

}  // namespace

/// Runs `exitance compare SOLUTION REFERENCE`.
ExitCode run(const CompareArguments& arguments, Terminal& terminal) {
    set_threads(arguments.threads);
    if (!arguments.map.empty() && ending(arguments.map) != ".png")
        return terminal.fail({ErrorCode::usage, "is written as .png", "--map", "exitance compare ... --map error.png"});
    const Result<Solution> solution = load_solution(arguments.solution);
    if (!solution) return terminal.fail(solution.error());
    const Result<ReferencePoints> reference = arguments.reference.ends_with(".h5")
                                                  ? reference_of_solution(arguments.reference, solution->scene)
                                                  : load_reference_points(arguments.reference);
    if (!reference) return terminal.fail(reference.error());

    const Evaluated what = arguments.interpolant ? Evaluated::interpolant : Evaluated::function;
    const ErrorMeasure error = error_against(*solution, *reference, what);
    if (!arguments.map.empty())
        if (const Result<void> written = write_map(arguments, *solution, *reference); !written)
            return terminal.fail(written.error());
    terminal.print(arguments.json ? error_json(error) : report(error));
    return ExitCode::done;
}

}  // namespace exitance
