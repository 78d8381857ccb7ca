#pragma once

#include "exitance/discontinuity/discontinuity_mesh.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// Gives a solution, whose reflected light is found, its discontinuity mesh: direct light on triangles that follow its
/// shadows, with what is reflected on top of it. The interpolant follows the mesh, the statistics tell of both; but for
/// the time, see the report. What is found on the way is kept at safe points, if there are any.
DiscontinuityReport add_discontinuity_mesh(const Stage& stage, const SolveOptions& options, Solution& solution,
                                           const StopRequest& stop, SafePoints* safe_points = nullptr);

}  // namespace exitance
