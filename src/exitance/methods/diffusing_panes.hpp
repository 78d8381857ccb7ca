#pragma once

#include "exitance/base/result.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// Does what is asked for take light to both sides of the scene's diffusing panes? A usage error names what does.
Result<void> check_diffusing_panes(const Scene& scene, const SolveOptions& options);

}  // namespace exitance
