#include "exitance/methods/carried_light.hpp"

namespace exitance {

bool is_lit_by_diffuse_surfaces(const Scene& scene) {
    return !scene.has_light_apart() && scene.panes().empty() && !scene.has_directed_emission();
}

Result<void> check_classic_cells(const Scene& scene, const SolveOptions& options) {
    const bool classic = options.method == Method::growing_cells && options.gcs == CellsKind::classic;
    if (!classic || is_lit_by_diffuse_surfaces(scene)) return {};
    return Error{ErrorCode::bad_input, "has lights without extent, lights that are not diffuse, or clear glass",
                 scene.file(),
                 "--gcs classic carries light between diffuse polygons only; --gcs improved supports this scene"};
}

}  // namespace exitance
