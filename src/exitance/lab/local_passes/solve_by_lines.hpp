#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/lab/local_passes/line_hierarchy.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// `--method discontinuity --local-pass a|b|c|d`: global pass and local pass as published (LineHierarchy,
/// run_local_pass). The light of emitters goes through links like all other; what comes out are quadratic triangles,
/// and the function that is solved for is what is exported. The error is estimated by the same residual as other
/// methods'; where it is more than asked for, links are refined and the passes run again. An Error where the scene has
/// light that links between diffuse polygons cannot carry.
Result<Solution> solve_by_lines(const Scene& scene, const SolveOptions& options, Progress& progress,
                                const StopRequest& stop);

/// The hierarchy's settings for a relative error: rules of thumb that the estimate checks.
LineHierarchyOptions line_options(const SolveOptions& options, double error);

}  // namespace exitance
