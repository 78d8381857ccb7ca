#include "exitance/methods/extensions.hpp"

#include <fmt/format.h>

#include "exitance/methods/methods.hpp"
#include "exitance/methods/options/support.hpp"

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
    if (options.method != Method::automatic && !find_method(form_of(options), options.method))
        return not_linked(fmt::format("{} method {}", form_of(options) == Form::standard ? "the" : "this form of the",
                                      name_in(method_names, options.method)),
                          "--method");
    const DiscontinuityChoice& c = options.discontinuity;
    const bool needs_lab = c.layers == true ||
                           c.triangulation.value_or(TriangulationScheme::delaunay) != TriangulationScheme::delaunay ||
                           c.structure.value_or(OccluderStructure::bvh) != OccluderStructure::bvh;
    if (needs_lab && !extensions().discontinuity) return not_linked("this form of the mesh", "--method discontinuity");
    return {};
}

}  // namespace exitance
