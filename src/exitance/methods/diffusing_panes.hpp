#pragma once

#include "exitance/base/result.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// Returns a usage error that names the offending option if the requested method cannot transport light to both sides
/// of the scene's diffusing panes.
Result<void> check_diffusing_panes(const Scene& scene, const SolveOptions& options);

}  // namespace exitance
