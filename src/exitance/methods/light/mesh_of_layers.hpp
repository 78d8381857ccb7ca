#pragma once

#include <string>

#include "exitance/base/result.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// Returns the options of a solve that determine its single discontinuity mesh, "--option value" a line; names of
/// surfaces after "surface ". Numbers are read back exactly.
std::string describe_mesh(const SolveOptions& options);

/// Reads the text of describe_mesh(). Error (bad_input): a line that is no such option.
Result<SolveOptions> read_mesh_options(const std::string& text);

/// Adds the single mesh to a solution that has layers in its place, for exports and views of one mesh; its interpolant
/// becomes that of the mesh. Does nothing for other solutions. The mesh is made from the scene and the options that the
/// layers record, and has the same bits as without --layers. Takes about as long as the solve took for the layers.
/// Error (usage): the layers record no options, or this program does not support them; (limit): `stop` was requested.
Result<void> make_requested_mesh(Solution& solution, const StopRequest& stop = StopRequest());

}  // namespace exitance
