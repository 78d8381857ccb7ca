#pragma once

#include <cstdint>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// The error of a body (at most `ErrorBudget::body()`) is relative to the light that the body reflects, or to this
/// share of the light of its room if that is more. A choice: it decides which errors of dark bodies count as wrong.
constexpr double min_body_light = 0.1;

/// A part of a scene for which an error is reported: faces that are joined by edges or belong to one named object. The
/// two sides of a sheet or of a plate are two bodies, since their light has nothing in common.
struct SceneBody {
    std::size_t surfaces = 0;  ///< Number of the body's faces.
    double area = 0;           ///< Area in m^2.
    Point centre = {};         ///< Mean of the centroids of the body's faces, weighted by area, metres.
    SurfaceId first = {};      ///< The first face of the body.
};

struct SceneBodies {
    std::vector<SceneBody> all;            ///< Sorted by first face.
    Field<SurfaceId, std::uint32_t> body;  ///< For every face, the index of its body in `all`.

    std::uint32_t of(const Scene& scene, RegionId region) const { return body[scene.regions()[region].surfaces[0]]; }
};

/// Finds the bodies of a scene. A body is a sheet or plate if at least two thirds of its area face one of two opposite
/// directions and its sides face away from each other; its rim belongs to the larger side. If there are more than
/// `max_bodies`, merges the smallest one repeatedly with the nearer of its two neighbours on a Morton curve through the
/// bodies' centres. O(n log n) in corners.
SceneBodies find_bodies(const Scene& scene, std::size_t max_bodies = 512);

}  // namespace exitance
