#pragma once

#include "exitance/base/result.hpp"
#include "exitance/cli/arguments.hpp"

namespace exitance {

/// Checks the options of `solve` and reads the points of --importance and the sky of --sky from files, before any other
/// work. Error: options that cannot be combined, files that cannot be used, or outputs that cannot be written.
Result<void> settle_options(SolveArguments& arguments);

}  // namespace exitance
