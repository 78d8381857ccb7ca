#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/direct/direct_light.hpp"

namespace exitance {

/// Convex faces of one region, in world coordinates.
struct FaceOutlines {
    /// Outlines of the faces, counter-clockwise about the region's normal, metres.
    std::vector<std::vector<Point>> faces;
    Vec3 u, v;  ///< Unit vectors that span the region's plane.
};

/// Finds the visible sources and candidate blockers of every face from those of the whole region. The faces are divided
/// into halves recursively. The blockers for the rectangle around each half are found once, so that a face tests only
/// blockers near its own lines of sight. `whole`: the light of the region; `lights`: receives the light of each face,
/// as many as there are faces. Faces not processed before `stop` is requested stay dark. O(log faces) tests per blocker
/// that matters; testing face by face would take O(faces).
void prepare_face_lights(const DirectLight& direct, const FaceOutlines& outlines, const ReceiverLight& whole,
                         std::span<ReceiverLight> lights, const StopRequest& stop, DirectLight::Workspace& workspace);

/// Moves the sides of a triangle inwards by `distance`, metres. Returns the triangle itself if the radius of its inner
/// circle is not at least twice the distance.
std::vector<Point> shrunk_triangle(const std::array<Point, 3>& corners, double distance);

}  // namespace exitance
