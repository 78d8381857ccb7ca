#pragma once

#include "exitance/cli/arguments.hpp"

namespace exitance {

/// An option that `--task-engine` does not obey is an error; so is `--threshold` where nothing is judged by it.
Result<void> check_task_engine(const SolveArguments& arguments);

}  // namespace exitance
