#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "exitance/scene/opposed_faces.hpp"
#include "exitance/visibility/narrow_gaps.hpp"
#include "exitance/visibility/rays.hpp"
#include "exitance/visibility/tracing_frame.hpp"

namespace exitance {

struct Float3 {
    float x, y, z;
};

/// Converts to single precision. Anything farther away than `far` sizes of the scene is clamped to that distance.
inline Float3 to_float(const Vec3& v) {
    constexpr double far = 1e15;  // derived from Embree, which accepts no coordinates beyond 1.8e18
    const auto within = [far](double c) { return static_cast<float>(std::clamp(c, -far, far)); };
    return {within(v.x), within(v.y), within(v.z)};
}

inline float without_less_than(float c, float limit) {
    return std::abs(c) < limit ? 0 : c;
}

// Embree replaces components of directions of less than 1e-18 by that number with a positive sign, and then tests the
// packet as if the sign were the ray's own: other rays of the packet pass through walls. Zero is safe.

/// Converts a point, with coordinates below 1e-9 replaced by 0. Others then differ by 0 or by more than 1e-18, so that
/// directions between points are safe, too.
inline Float3 to_safe_point(const Vec3& v) {
    constexpr float smallest = 1e-9F;
    const Float3 p = to_float(v);
    return {without_less_than(p.x, smallest), without_less_than(p.y, smallest), without_less_than(p.z, smallest)};
}

/// Converts a direction, with components that are too small replaced by 0. `smallest` is derived from Embree's 1e-18,
/// and `negligible` is far below the rounding of the largest component, 6e-8 of it.
inline Float3 to_safe_direction(const Vec3& v) {
    constexpr float smallest = 2e-18F, negligible = 1e-12F;
    const Float3 d = to_float(v);
    const float limit = std::max(smallest, negligible * std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}));
    return {without_less_than(d.x, limit), without_less_than(d.y, limit), without_less_than(d.z, limit)};
}

/// The data of a surface that a hit needs, contiguous in memory.
struct TracedFace {
    Normal normal;
    Point corner;
    RegionId region;
};

/// Triangle mesh in Embree's layout.
struct Triangles {
    std::vector<Float3> corners;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A scene as rays meet it, in the tracer's coordinates and single precision: relative to the middle of its box, scaled
/// so that the scene is about 1 wide, rotated (TracingFrame). The ends of rays are lifted off their regions, so that
/// rays do not meet them.
struct TracedScene {
    static constexpr double lift = 0x1p-20;  ///< Share of the scene's size: 16 roundings of a coordinate.
    static constexpr double stack_step = lift / 2;

    /// The scene must outlive this object.
    explicit TracedScene(const Scene& s);

    /// The triangles of all surfaces, one set for both sides of a sheet. Stacked coplanar surfaces are separated, so
    /// that the upper one is hit first. `surface_of`: the surface of each triangle.
    Triangles surfaces(std::vector<SurfaceId>& surface_of) const;
    /// The triangles of all panes. `pane_of`: the pane of each triangle.
    Triangles panes(std::vector<std::uint32_t>& pane_of) const;

    Float3 local(const Point& p) const { return to_safe_point(frame(scale * (p - centre))); }
    Float3 local_direction(const Vec3& d) const { return to_safe_direction(frame(scale * d)); }
    /// Vector by which the ends of rays on a region are lifted off it, metres.
    Vec3 offset(RegionId region) const {
        if (region.is_none()) return Vec3();
        return (lift_off + raised(region)) * scene->regions()[region].plane.n;
    }
    /// Height above its plane at which rays meet a region, because it is on top of others there, metres.
    double raised(RegionId region) const { return stack_step * scene->size() * scene->regions()[region].level; }
    /// Faces that are closer to a region than the usual start of rays.
    NarrowGaps narrow_gaps() const;

    const Scene* scene;
    Point centre;        ///< Origin of the tracer's coordinates.
    double scale;        ///< Power of two by which they are scaled, so that a scene of any size is about 1 wide.
    TracingFrame frame;  ///< Rotation to them.
    double lift_off;     ///< Distance by which rays are lifted off a region, metres.
    Field<SurfaceId, TracedFace> faces;
    /// The surface on the other side of a sheet; empty if there are no sheets.
    Field<SurfaceId, SurfaceId> other_side;
};

}  // namespace exitance
