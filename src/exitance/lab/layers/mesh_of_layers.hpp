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

/// Adds the single mesh to a solution with layers, from the scene and the options that the layers record. Error
/// (usage): they record none; (limit): `stop` was requested.
Result<void> make_mesh_of_layers(Solution& solution, const StopRequest& stop);

}  // namespace exitance
