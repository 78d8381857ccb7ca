#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/lab/local_passes/line_hierarchy.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// Solves for `--method discontinuity --local-pass a|b|c|d`: global and local pass as published (LineHierarchy,
/// run_local_pass). Links transport the light of emitters as well. The result are quadratic triangles, and the function
/// that is solved for is exported. The error is estimated by the residual, as for other methods; if it exceeds the
/// requested one, links are refined and the passes are repeated. Returns an Error if the scene has light that links
/// between diffuse polygons cannot transport.
Result<Solution> solve_by_lines(const Scene& scene, const SolveOptions& options, Progress& progress,
                                const StopRequest& stop);

/// Returns the hierarchy's settings for a relative error: rules of thumb that the error estimate checks.
LineHierarchyOptions line_options(const SolveOptions& options, double error);

}  // namespace exitance
