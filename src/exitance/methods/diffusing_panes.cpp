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
        return Error{ErrorCode::usage, "takes light to one side of a surface; the scene has diffusing panes", option,
                     "without it light comes to both, by any method; auto chooses matrix"};
    const Relaxation relaxation = options.relaxation.value_or(Relaxation::gmres);
    if (relaxation == Relaxation::cg || relaxation == Relaxation::chebyshev)
        return Error{ErrorCode::usage, "asks for symmetry, which diffusing panes leave the system without",
                     "--relaxation", "gmres, jacobi and gauss-seidel do without"};
    return {};
}

}  // namespace exitance
