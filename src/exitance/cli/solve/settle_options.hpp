#pragma once

#include "exitance/base/result.hpp"
#include "exitance/cli/arguments.hpp"

namespace exitance {

/// Makes options of what `solve` was given before any work: what one option says for another, points and skies that are
/// read from files. Error: options that do not go together, files that are wrong, or outputs that cannot be written.
Result<void> settle_options(SolveArguments& arguments);

}  // namespace exitance
