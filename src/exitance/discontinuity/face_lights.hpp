#pragma once

#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/direct/direct_light.hpp"
#include "exitance/mesh/discontinuity/six_node_mesh.hpp"

namespace exitance {

/// Convex faces of one region, in world coordinates.
struct FaceOutlines {
    std::vector<std::vector<Point>> faces;  ///< Counter-clockwise about the region's normal, metres.
    Vec3 u, v;                              ///< Unit vectors that span the region's plane.
};

/// Finds the visible sources and candidate blockers of every face from those of the whole region. The faces are divided
/// into halves recursively. The blockers for the rectangle around each half are found once, so that a face tests only
/// blockers near its own lines of sight. `whole`: the light of the region; `lights`: receives the light of each face,
/// as many as there are faces. Faces not processed before `stop` is requested stay dark. O(log faces) tests per blocker
/// that matters; testing face by face would take O(faces).
void prepare_face_lights(const DirectLight& direct, const FaceOutlines& outlines, const ReceiverLight& whole,
                         std::span<ReceiverLight> lights, const StopRequest& stop, DirectLight::Workspace& workspace);

/// Classifies a face: all sources that its front can see are visible (lit), none is (umbra), or neither (penumbra).
/// `centre`: centre of the face or of a part of it.
ShadowClass shadow_class(const DirectLight& direct, const ReceiverLight& light, const Point& centre);

/// Likewise, for the sources `among` only.
ShadowClass shadow_class(const DirectLight& direct, const ReceiverLight& light, const Point& centre,
                         std::span<const DirectLight::SourceName> among);

}  // namespace exitance
