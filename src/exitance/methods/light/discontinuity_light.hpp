#pragma once

#include "exitance/discontinuity/discontinuity_mesh.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// Adds a discontinuity mesh to a solution whose reflected light is known: direct light on triangles that follow its
/// shadows, plus the reflected light. Replaces the interpolant by the mesh and records statistics, except for times,
/// which are in the report. If `safe_points` is given, intermediate results are saved there.
DiscontinuityReport add_discontinuity_mesh(const Stage& stage, const SolveOptions& options, Solution& solution,
                                           const StopRequest& stop, SafePoints* safe_points = nullptr);

}  // namespace exitance
