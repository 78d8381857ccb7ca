#pragma once

#include <string_view>

#include "exitance/base/result.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// What a solve would take, before it is done: `solve --dry-run`.
struct Forecast {
    std::string_view method;  ///< That would solve.
    std::size_t surfaces = 0, regions = 0, emitters = 0;
    std::size_t solve_elements = 0;   ///< That the method would solve on, following direct light.
    std::size_t gather_elements = 0;  ///< That indirect light would be gathered on.
    double rays = 0;
    double seconds = 0;       ///< Wall time on the threads in force.
    double memory_bytes = 0;  ///< At most.
};

/// Makes the plan that the solve would make, projects direct light on its elements, and gathers the light that is
/// reflected first at a few hundred points: their noise tells the rays, their time the seconds. What is known by ratios
/// alone is how much further elements are cut where reflected light asks for it; and whether the certificate sends
/// everything round once more is unknown until then. Takes what direct light takes, mostly a tenth of the solve.
Result<Forecast> forecast_solve(const Scene& scene, const SolveOptions& options);

}  // namespace exitance
