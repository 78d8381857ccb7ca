#include "exitance/view_factors/row_scene.hpp"

#include <algorithm>

#include "exitance/view_factors/accuracy.hpp"

namespace exitance {

RowScene::RowScene(const Scene& s, const StopRequest& stop)
    : scene(s),
      occluders(s),
      tracer(s),
      faces(make_view_faces(s)),
      slack(plane_slack(occluders)),
      hidden_parts(occluders, faces, slack, stop, &tracer) {
    samplers.reserve(faces.size());
    for (SurfaceId id : s.surfaces().ids()) samplers.emplace_back(s, id);
    for (const ViewFace& face : faces) {
        Point middle{};
        for (const Point& p : face.outline) middle = middle + p * (1.0 / static_cast<double>(face.outline.size()));
        double radius = 0;
        for (const Point& p : face.outline) radius = std::max(radius, norm(p - middle));
        middles.push_back(middle), radii.push_back(radius);
    }
    near = NearFaces(faces, middles, radii);
}

}  // namespace exitance
