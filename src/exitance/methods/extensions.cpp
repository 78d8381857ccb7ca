#include "exitance/methods/extensions.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/methods/methods.hpp"

namespace exitance {
namespace {

Error not_linked(std::string what, std::string option) {
    return {ErrorCode::usage, std::move(what) + " is not part of this program, which is linked without exitance-lab",
            std::move(option), "choose another method, or link exitance-lab and call install_laboratory()"};
}

}  // namespace

Extensions& extensions() {
    static Extensions ours;
    return ours;
}

Result<void> check_extensions(const SolveOptions& options) {
    if (options.method != Method::automatic && !find_method(options.method))
        return not_linked(fmt::format("method {}", name_in(method_names, options.method)), "--method");
    const bool has_other_pass = options.local_pass.value_or(LocalPassRule::e) != LocalPassRule::e;
    const auto& solves = extensions().solves;
    const bool has_solve =
        std::any_of(solves.begin(), solves.end(), [&](const WholeSolve& whole) { return whole.is_selected(options); });
    if ((has_other_pass || options.task_engine) && !has_solve)
        return not_linked("this form of the method", has_other_pass ? "--local-pass" : "--task-engine");
    const DiscontinuityChoice& c = options.discontinuity;
    const bool needs_lab = c.layers == true ||
                           c.triangulation.value_or(TriangulationScheme::delaunay) != TriangulationScheme::delaunay ||
                           c.structure.value_or(OccluderStructure::bvh) != OccluderStructure::bvh;
    if (needs_lab && !extensions().discontinuity) return not_linked("this form of the mesh", "--method discontinuity");
    return {};
}

}  // namespace exitance
