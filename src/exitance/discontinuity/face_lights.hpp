#pragma once

#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/direct/direct_light.hpp"
#include "exitance/mesh/discontinuity/six_node_mesh.hpp"

namespace exitance {

/// Convex faces of one region in space, and what shines on them.
struct FaceOutlines {
    std::vector<std::vector<Point>> faces;  ///< Counter-clockwise about the region's normal.
    Vec3 u, v;                              ///< Directions in the region's plane.
};

/// What shines on each face, of what shines on the whole region: halves of the faces look first together at what may
/// hide the sources from the rectangle around them, so that a face looks at what is near its own lines of sight only.
/// O(log faces) looks at each blocker that matters, where all faces would look at all blockers of the region. `lights`
/// is as long as there are faces. What has not been looked at when `stop` is requested stays dark.
void prepare_face_lights(const DirectLight& direct, const FaceOutlines& outlines, const ReceiverLight& whole,
                         std::span<ReceiverLight> lights, const StopRequest& stop, DirectLight::Workspace& workspace);

/// Are the sources that a face's front can see all lit, all hidden, or neither? `centre`: of the face or of a part.
ShadowClass shadow_class(const DirectLight& direct, const ReceiverLight& light, const Point& centre);

/// The same of these sources alone.
ShadowClass shadow_class(const DirectLight& direct, const ReceiverLight& light, const Point& centre,
                         std::span<const DirectLight::SourceName> among);

}  // namespace exitance
