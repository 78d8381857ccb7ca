#pragma once

#include "exitance/scene/scene.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// What a solve would take, before it is done: `solve --dry-run`.
struct Forecast {
    std::size_t surfaces = 0, regions = 0, emitters = 0;
    std::size_t solve_elements = 0;   ///< That the method would solve on, before they follow the light.
    std::size_t gather_elements = 0;  ///< That indirect light would be gathered on, likewise.
    double rays = 0;
    double seconds = 0;       ///< Wall time on the threads in force.
    double memory_bytes = 0;  ///< At most.
};

/// Counts elements by the knobs that the error asked for leads to, and times a few hundred gathers and direct lights of
/// this scene on this machine. How much further elements are cut where the light asks for it, and whether the
/// certificate sends everything round once more, is unknown until then: good to a factor of about five. Some 0.1 s and
/// what the scene's ray tracer takes to make.
Forecast forecast_solve(const Scene& scene, const SolveOptions& options);

}  // namespace exitance
