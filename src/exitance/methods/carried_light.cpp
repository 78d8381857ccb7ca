#include "exitance/methods/carried_light.hpp"

#include <fmt/format.h>

#include <string>

#include "exitance/methods/options/support.hpp"

namespace exitance {
namespace {

/// Advice for scenes with other emitters; null if the options do not carry their light.
const char* advice_for_other_emitters(const SolveOptions& options) {
    switch (form_of(options)) {
        case Form::local_passes:
            return "--local-pass a to d carries light between diffuse polygons alone: e carries this light, too";
        case Form::tasks:
            return "--task-engine carries light between diffuse patches alone: leave it out";
        case Form::published:
            return options.classical.carried() ? "--direct apart supports all emitters" : nullptr;
        case Form::standard:
            break;
    }
    const bool classic = options.method == Method::growing_cells && options.gcs == CellsKind::classic;
    return classic ? "--gcs classic carries light between diffuse polygons only; --gcs improved supports this scene"
                   : nullptr;
}

}  // namespace

bool is_lit_by_diffuse_surfaces(const Scene& scene) {
    return !scene.has_light_apart() && scene.panes().empty() && !scene.has_directed_emission();
}

Result<void> check_carried_light(const Scene& scene, const SolveOptions& options) {
    const char* const advice = advice_for_other_emitters(options);
    if (!advice || is_lit_by_diffuse_surfaces(scene)) return {};
    std::string found;
    const auto add = [&](bool is_there, const char* words) {
        if (is_there) found += (found.empty() ? "" : " and ") + std::string(words);
    };
    add(scene.has_light_apart(), "light that no surface emits (a sky, a sun or lights without extent)");
    add(scene.has_directed_emission(), "lights that are not diffuse");
    add(!scene.panes().empty(), "clear glass");
    return Error{ErrorCode::bad_input, fmt::format("has {}, which the method's own transport cannot carry", found),
                 scene.file(), advice};
}

}  // namespace exitance
