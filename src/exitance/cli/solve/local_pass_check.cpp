#include "exitance/cli/solve/local_pass_check.hpp"

#include <array>

namespace exitance {

Result<void> check_local_pass(const SolveArguments& arguments) {
    const SolveOptions& o = arguments.options;
    if (o.local_pass.value_or(LocalPassRule::e) == LocalPassRule::e) return {};
    const bool other_visibility =
        o.visibility != VisibilityKind::automatic && o.visibility != VisibilityKind::fractional;
    const std::array<std::pair<const char*, bool>, 22> disobeyed{{
        {"--bounces", o.bounces != all_bounces},
        {"--epsilon", o.epsilon.has_value()},
        {"--mesh-size", o.mesh_size.has_value()},
        {"--min-area", o.min_area.has_value()},
        {"--residual", o.residual.has_value()},
        {"--max-iterations", o.max_iterations.has_value()},
        {"--relaxation", o.relaxation.has_value()},
        {"--overshooting", o.overshooting},
        {"--visibility", other_visibility},
        {"--triage", !o.triage},
        {"--clusters", o.clusters.has_value()},
        {"--smoothing", o.smoothing.has_value()},
        {"--importance", !arguments.importance.empty()},
        {"--keep-links", o.keep_links},
        {"--oracle", o.oracle != LinkOracle::transport},
        {"--form-factors", o.form_factors && *o.form_factors != FormFactorKind::analytic},
        {"--hemicube-cells", o.hemicube_cells.has_value()},
        {"--memory-limit", o.memory_limit_bytes.has_value()},
        {"--checkpoint-every", arguments.checkpoint_every.has_value()},
        {"--resume", arguments.resume},
        {"--dry-run", arguments.dry_run},
        {"a classical form", arguments.classical.any()},
    }};
    for (const auto& [name, is_given] : disobeyed)
        if (is_given)
            return Error{ErrorCode::usage, "is not obeyed by --local-pass a to d", name,
                         "leave it out, or leave out --local-pass"};
    return {};
}

}  // namespace exitance
