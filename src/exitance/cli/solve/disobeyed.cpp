#include "exitance/cli/solve/disobeyed.hpp"

#include <string>

namespace exitance {

Result<void> refuse_given(std::span<const GivenOption> options, const char* form, const char* hint) {
    for (const GivenOption& option : options)
        if (option.is_given) return Error{ErrorCode::usage, std::string("is not obeyed by ") + form, option.name, hint};
    return {};
}

std::vector<GivenOption> options_of_methods(const SolveArguments& arguments) {
    const SolveOptions& o = arguments.options;
    const bool other_visibility =
        o.visibility != VisibilityKind::automatic && o.visibility != VisibilityKind::fractional;
    return {
        {"--epsilon", o.epsilon.has_value()},
        {"--mesh-size", o.mesh_size.has_value()},
        {"--bounces", o.bounces != all_bounces},
        {"--relaxation", o.relaxation.has_value()},
        {"--overshooting", o.overshooting},
        {"--visibility", other_visibility},
        {"--importance", !arguments.importance.empty() || !o.importance.empty()},
        {"--keep-links", o.keep_links},
        {"--form-factors", o.form_factors && *o.form_factors != FormFactorKind::analytic},
        {"--hemicube-cells", o.hemicube_cells.has_value()},
        {"--memory-limit", o.memory_limit_bytes.has_value()},
        {"--checkpoint-every", arguments.checkpoint_every.has_value()},
        {"--resume", arguments.resume},
        {"--dry-run", arguments.dry_run},
    };
}

}  // namespace exitance
