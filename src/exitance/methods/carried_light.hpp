#pragma once

#include "exitance/base/result.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// Returns true if diffuse surfaces emit all of the scene's light and it has no clear glass. Methods that carry the
/// light of emitters from element to element support only such scenes.
bool is_lit_by_diffuse_surfaces(const Scene& scene);

/// Returns an error if the options carry the light of emitters from element to element, but the scene is not lit by
/// diffuse surfaces only.
Result<void> check_carried_light(const Scene& scene, const SolveOptions& options);

}  // namespace exitance
