#pragma once

#include "exitance/base/vec.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Rotation from the scene's coordinates to those in which rays are traced.
struct TracingFrame {
    Normal x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< Axes of the rotated system, in the scene's coordinates.
    bool is_turned = false;                     ///< False: the systems are the same.

    Vec3 operator()(const Vec3& v) const { return is_turned ? Vec3{dot(x, v), dot(y, v), dot(z, v)} : v; }
};

/// Finds a frame in which the boxes of the faces are small. Trees of boxes that are parallel to the axes are traversed
/// several times faster if most faces are, too: a long face askew to the axes has a box that overlaps all of its
/// neighbours. Candidates are the frames of edges of the largest faces. The scene's own frame is kept unless another
/// one is better by far, so that scenes that are parallel to the axes are traced in their own coordinates. O(faces).
TracingFrame find_tracing_frame(const Scene& scene);

}  // namespace exitance
