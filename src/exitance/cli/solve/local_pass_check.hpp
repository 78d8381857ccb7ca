#pragma once

#include "exitance/base/result.hpp"
#include "exitance/cli/arguments.hpp"

namespace exitance {

/// An option that `--local-pass a|b|c|d` does not obey is an error.
Result<void> check_local_pass(const SolveArguments& arguments);

}  // namespace exitance
