#pragma once

#include <cstddef>
#include <string_view>

#include "exitance/base/result.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// Predicted cost of a solve, for `solve --dry-run`.
struct Forecast {
    std::string_view method;  ///< Name of the method.
    std::size_t surfaces = 0, regions = 0, emitters = 0;
    std::size_t solve_elements = 0;   ///< Elements on which the method solves, refined for direct light.
    std::size_t gather_elements = 0;  ///< Elements on which indirect light is gathered.
    double rays = 0;
    double seconds = 0;       ///< Wall time with the present number of threads.
    double memory_bytes = 0;  ///< Upper limit.
    /// True if a mesh reached its limit on elements. All other numbers then are lower limits.
    bool is_at_least = false;
};

/// Number of elements that a forecast adds to the pieces of a scene: about 100 MB.
inline constexpr std::size_t max_forecast_elements = 100'000;

/// Makes the plan of the solve, projects direct light on its elements, and gathers the light of the first reflection at
/// a few hundred points. Their noise gives the number of rays, their time the seconds. Further splitting of elements
/// for reflected light is estimated by fixed ratios. It is unknown whether the certificate will require another
/// attempt. Takes as long as direct light does, typically a tenth of the solve.
///
/// For published forms on constant elements, the elements and the rays are those of the form. A ray of the form takes a
/// quarter of the time of a gather's ray.
/// max_elements  limit on the elements that are added to the pieces of the scene
Result<Forecast> forecast_solve(const Scene& scene, const SolveOptions& asked,
                                std::size_t max_elements = max_forecast_elements);

}  // namespace exitance
