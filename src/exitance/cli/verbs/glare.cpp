#include <fmt/format.h>

#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/cli/json_output.hpp"
#include "exitance/cli/observers.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/measure/floor_rooms.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

constexpr std::size_t printed_sources = 10;

std::string as_text(const Observer& observer, const DaylightGlare& glare, std::optional<double> error) {
    const double probability = glare.probability();
    const auto triple = [](const auto& v) { return fmt::format("{:.6g},{:.6g},{:.6g}", v.x, v.y, v.z); };
    std::string text = fmt::format(
        "observer   {} {}\nDGP        {:.3f} {}{}\nE_v        {:.4g} lx; mean luminance {:.4g} cd/m^2\n"
        "sources    {} above {:.4g} cd/m^2\n",
        triple(observer.eye), triple(observer.view), probability, glare_class(probability),
        error ? fmt::format(" ({:.3f} to {:.3f} with the error of {:.2g}% of the light)",
                            glare.probability_with(1 - *error), glare.probability_with(1 + *error), 100 * *error)
              : std::string(),
        glare.vertical_illuminance, glare.mean_luminance, glare.sources.size(), glare.threshold);
    for (std::size_t k = 0; k < std::min(printed_sources, glare.sources.size()); ++k) {
        const DaylightGlareSource& s = glare.sources[k];
        text += fmt::format("           {}: {:.4g} cd/m^2, {:.3g} sr, P {:.3g}, towards {}\n", glare.names[k],
                            s.luminance, s.solid_angle, s.position, triple(s.towards));
    }
    return text;
}

}  // namespace

/// Runs `exitance glare SOLUTION --observers OBSERVERS`.
ExitCode run(const GlareArguments& arguments, Terminal& terminal) {
    set_threads(arguments.threads);
    const Result<Solution> solution = load_solution(arguments.solution);
    if (!solution) return terminal.fail(solution.error());
    const Scene& scene = solution->scene;
    const LightUnit lux(UnitChoice::lux, scene.is_photometric(), arguments.efficacy.value_or(daylight_efficacy));
    if (arguments.efficacy && !lux.is_converted())
        terminal.note("--efficacy has no effect: light in lumens is not converted");
    const RadiosityFunction light(*solution);
    const FloorRooms rooms = need_rooms(arguments.observers) ? FloorRooms(scene, light.stage().tracer) : FloorRooms();
    const Result<std::vector<Observer>> observers = find_observers(arguments.observers, light.stage(), rooms);
    if (!observers) return terminal.fail(observers.error());
    const StopRequest& stop = terminal.limits().stop();
    std::vector<DaylightGlare> glare;
    terminal.progress().phase("glare");
    for (const Observer& observer : *observers) {
        glare.push_back(find_daylight_glare(light, observer, lux, arguments.threshold));
        if (stop.requested()) return terminal.fail_stopped("the observers are not finished");
        terminal.progress().advance(static_cast<double>(glare.size()) / static_cast<double>(observers->size()));
    }
    terminal.progress().finish();
    // The eye may be in any room.
    const std::optional<double> error =
        std::max(solution->statistics.relative_error_estimate, solution->statistics.relative_error_estimate_worst_room);
    if (arguments.json) {
        terminal.print(glare_json(*observers, glare, error));
    } else {
        for (std::size_t i = 0; i < glare.size(); ++i) terminal.print(as_text((*observers)[i], glare[i], error));
    }
    return ExitCode::done;
}

}  // namespace exitance
