#pragma once

#include <cstdint>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// A part of a scene by which errors are judged: faces that are joined by edges or belong to one named object.
struct SceneBody {
    std::size_t surfaces = 0;  ///< Number of its faces.
    double area = 0;           ///< m^2
    Point centre = {};         ///< Mean of its faces' centroids, weighted by area, metres.
    SurfaceId first = {};      ///< The first of its faces.
};

struct SceneBodies {
    std::vector<SceneBody> all;            ///< In the order of their first faces.
    Field<SurfaceId, std::uint32_t> body;  ///< Index into `all` of every face.

    std::uint32_t of(const Scene& scene, RegionId region) const { return body[scene.regions()[region].surfaces[0]]; }
};

/// Finds the bodies of a scene. Where there are more than `max_bodies`, the smallest ones are pooled with a neighbour,
/// one after another; neighbours are those beside each other on a Morton curve through the bodies' centres.
/// O(n log n) in corners.
SceneBodies find_bodies(const Scene& scene, std::size_t max_bodies = 512);

}  // namespace exitance
