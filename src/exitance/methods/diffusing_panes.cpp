#include "exitance/methods/diffusing_panes.hpp"

namespace exitance {

Result<void> check_diffusing_panes(const Scene& scene, const SolveOptions& options) {
    if (!scene.has_diffusing_panes()) return {};
    const bool by_lines = options.local_pass.value_or(LocalPassRule::e) != LocalPassRule::e;
    const char* const option = by_lines              ? "--local-pass"
                               : options.task_engine ? "--task-engine"
                               : options.method != Method::automatic && options.method != Method::matrix ? "--method"
                                                                                                         : nullptr;
    if (option)
        return Error{ErrorCode::usage, "takes light to one side of a surface; the scene has diffusing panes", option,
                     "--method matrix (which auto chooses) takes it to both"};
    if (options.basis && is_galerkin(*options.basis))
        return Error{ErrorCode::usage, "blocks of Galerkin's matrix take light to one side of a diffusing pane",
                     "--basis", "rows by rays take it to both: --basis constant or linear"};
    if (options.form_factors.value_or(FormFactorKind::ray_cast) != FormFactorKind::ray_cast)
        return Error{ErrorCode::usage, "takes light to one side of a surface; the scene has diffusing panes",
                     "--form-factors", "--form-factors ray-cast takes it to both"};
    const Relaxation relaxation = options.relaxation.value_or(Relaxation::gmres);
    if (relaxation == Relaxation::cg || relaxation == Relaxation::chebyshev)
        return Error{ErrorCode::usage, "asks for symmetry, which diffusing panes leave the system without",
                     "--relaxation", "gmres, jacobi and gauss-seidel do without"};
    return {};
}

}  // namespace exitance
