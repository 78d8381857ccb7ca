#include "exitance/cli/solve/task_engine_check.hpp"

#include <fmt/format.h>

#include <array>

namespace exitance {

Result<void> check_task_engine(const SolveArguments& arguments) {
    const SolveOptions& o = arguments.options;
    if (!o.task_engine) return {};
    if (arguments.classical.any())
        return Error{ErrorCode::usage, "is a classical form of its own: of their options it takes --threshold alone",
                     "--task-engine", "leave --task-engine or the others out"};
    if (o.method != Method::hierarchical)
        return Error{ErrorCode::usage, "is a form of --method hierarchical", "--task-engine",
                     "exitance solve SCENE -o S.h5 --method hierarchical --task-engine"};
    const bool other_visibility =
        o.visibility != VisibilityKind::automatic && o.visibility != VisibilityKind::fractional;
    const std::array<std::pair<const char*, bool>, 17> disobeyed{{
        {"--error", o.error.has_value()},
        {"--error-interpolant", o.error_interpolant.has_value()},
        {"--epsilon", o.epsilon.has_value()},
        {"--mesh-size", o.mesh_size.has_value()},
        {"--bounces", o.bounces != all_bounces},
        {"--relaxation", o.relaxation.has_value()},
        {"--overshooting", o.overshooting},
        {"--visibility", other_visibility},
        {"--clusters", o.clusters == true},
        {"--importance", !arguments.importance.empty() || !o.importance.empty()},
        {"--keep-links", o.keep_links},
        {"--form-factors", o.form_factors && *o.form_factors != FormFactorKind::analytic},
        {"--hemicube-cells", o.hemicube_cells.has_value()},
        {"--memory-limit", o.memory_limit_bytes.has_value()},
        {"--checkpoint-every", arguments.checkpoint_every.has_value()},
        {"--resume", arguments.resume},
        {"--dry-run", arguments.dry_run},
    }};
    for (const auto& [name, is_given] : disobeyed)
        if (is_given)
            return Error{ErrorCode::usage, "is not obeyed by --task-engine", name,
                         "without --task-engine, --method hierarchical obeys it"};
    return {};
}

}  // namespace exitance
