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

/// Adds the single mesh to a solution that has layers in its place, for exports and views of one mesh; its interpolant
/// becomes that of the mesh. Does nothing for other solutions. The mesh has the same bits as without --layers. Takes
/// about as long as the solve took for the layers. Error: this program cannot make the mesh, or `stop` was requested.
Result<void> make_requested_mesh(Solution& solution, const StopRequest& stop = StopRequest());

}  // namespace exitance
