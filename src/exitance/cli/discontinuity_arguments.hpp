#pragma once

#include "exitance/cli/arguments.hpp"

namespace CLI {
class App;
}

namespace exitance {

/// Options of discontinuity meshing.
void declare_discontinuity(CLI::App& app, SolveOptions& options);

/// Why the choices cannot be obeyed together, if they cannot.
Result<void> check_discontinuity(const SolveOptions& options);

}  // namespace exitance
