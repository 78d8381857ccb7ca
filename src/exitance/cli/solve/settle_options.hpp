#pragma once

#include "exitance/base/result.hpp"
#include "exitance/cli/options/arguments.hpp"

namespace exitance {

/// Checks the options of `solve` and reads the points of --importance and the sky of --sky from files, before any other
/// work. Error: options that cannot be combined, files that cannot be used, or outputs that cannot be written.
Result<void> settle_options(SolveArguments& arguments);

/// Reads the sky of --sky, and the weather of --epw for it, into the options for loading the scene.
Result<void> read_sky(const SolveRequest& request, LoadOptions& load);

}  // namespace exitance
