#pragma once

#include "exitance/methods/extensions.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// Adds a discontinuity mesh to a solution whose reflected light is known: direct light on triangles that follow its
/// shadows, plus the reflected light. If layers are requested, adds those of direct light instead, and no mesh.
/// Replaces the interpolant accordingly and records statistics, except for times, which are in the report. If
/// `safe_points` is given, intermediate results of the mesh are saved there. `show` receives the layers of
/// the sources so far after each source, unless it is empty.
DiscontinuityReport add_discontinuity_mesh(const Stage& stage, const SolveOptions& options, Solution& solution,
                                           const StopRequest& stop, SafePoints* safe_points = nullptr,
                                           const ShowLayers& show = {});

/// The single mesh of a solution, whether it has layers or not. Empty if `stop` is requested too early.
SixNodeMesh single_discontinuity_mesh(const Stage& stage, const SolveOptions& options, const Solution& solution,
                                      const StopRequest& stop);

}  // namespace exitance
