#include "exitance/methods/diffusing_panes.hpp"

#include "exitance/methods/options/support.hpp"

namespace exitance {
namespace {

/// The option that selects a form without light through surfaces; null if the form has such light.
const char* one_sided_option(const SolveOptions& options) {
    switch (form_of(options)) {
        case Form::local_passes:
            return "--local-pass";
        case Form::tasks:
            return "--task-engine";
        case Form::published:
            return "--recipe";
        case Form::standard:
            break;
    }
    return options.method == Method::growing_cells && options.gcs == CellsKind::classic ? "--gcs" : nullptr;
}

}  // namespace

Result<void> check_diffusing_panes(const Scene& scene, const SolveOptions& options) {
    if (!scene.has_diffusing_panes()) return {};
    if (const char* const option = one_sided_option(options))
        return Error{ErrorCode::usage, "carries light to one side of a surface, but the scene has diffusing panes",
                     option, "leave the option out: all methods then support both sides, and auto chooses matrix"};
    const Relaxation relaxation = options.relaxation.value_or(Relaxation::gmres);
    if (relaxation == Relaxation::cg || relaxation == Relaxation::chebyshev)
        return Error{ErrorCode::usage, "needs a symmetric system, which diffusing panes make asymmetric",
                     "--relaxation", "use gmres, jacobi or gauss-seidel"};
    return {};
}

}  // namespace exitance
