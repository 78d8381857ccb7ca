#pragma once

#include "exitance/base/check.hpp"
#include "exitance/methods/solve_scene.hpp"

namespace exitance {

/// Returns the solution of a scene; aborts the test if there is none.
inline Solution solved(const Scene& scene, const SolveOptions& options) {
    Progress progress;
    const StopRequest stop;
    Result<Solution> solution = solve_scene(scene, options, progress, stop);
    EXI_CHECK(static_cast<bool>(solution));
    return std::move(*solution);
}

}  // namespace exitance
