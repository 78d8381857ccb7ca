#pragma once

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Distance by which rays that start on a region are lifted off its plane, as a share of the scene's size: 16 roundings
/// of a coordinate in single precision.
constexpr double ray_lift_share = 0x1p-20;

/// Vector by which RayTracer lifts rays off the region they start on, metres; 0 for none.
inline Vec3 ray_lift(const Scene& scene, RegionId region) {
    if (region.is_none()) return {};
    const Region& own = scene.regions()[region];
    return ray_lift_share * (1 + 0.5 * own.level) * scene.size() * own.plane.n;
}

}  // namespace exitance
