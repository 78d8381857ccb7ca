#include "exitance/view_factors/row_scene.hpp"

#include <algorithm>

namespace exitance {

RowScene::RowScene(const Scene& s)
    : scene(s),
      occluders(s),
      tracer(s),
      faces(make_view_faces(s)),
      slack(std::max(1e-8 * s.size(), occluders.rounding())) {
    samplers.reserve(faces.size());
    for (SurfaceId id : s.surfaces().ids()) samplers.emplace_back(s, id);
}

}  // namespace exitance
