#include "exitance/methods/diffusing_panes.hpp"

namespace exitance {

Result<void> check_diffusing_panes(const Scene& scene, const SolveOptions& options) {
    if (!scene.has_diffusing_panes()) return {};
    const bool by_lines = options.local_pass.value_or(LocalPassRule::e) != LocalPassRule::e;
    const bool classic_cells = options.method == Method::growing_cells && options.gcs == CellsKind::classic;
    const char* const option = by_lines              ? "--local-pass"
                               : options.task_engine ? "--task-engine"
                               : classic_cells       ? "--gcs"
                                                     : nullptr;
    if (option)
        return Error{ErrorCode::usage, "carries light to one side of a surface, but the scene has diffusing panes",
                     option, "leave the option out: all methods then support both sides, and auto chooses matrix"};
    const Relaxation relaxation = options.relaxation.value_or(Relaxation::gmres);
    if (relaxation == Relaxation::cg || relaxation == Relaxation::chebyshev)
        return Error{ErrorCode::usage, "needs a symmetric system, which diffusing panes make asymmetric",
                     "--relaxation", "use gmres, jacobi or gauss-seidel"};
    return {};
}

}  // namespace exitance
