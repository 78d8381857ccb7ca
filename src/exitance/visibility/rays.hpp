#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "exitance/scene/surface_point.hpp"

namespace exitance {

/// First hit of a ray.
struct RayHit {
    SurfaceId surface;  ///< The surface that is hit; none if nothing is hit.
    RegionId region;    ///< The surface's region.
    /// Distance in units of the length of the ray's direction.
    double distance = std::numeric_limits<double>::infinity();
    bool front = false;        ///< True if the front of the surface is hit.
    bool is_glass = false;     ///< True if a pane stopped the ray; it counts as the back of some surface.
    std::int32_t mirror = -1;  ///< Index of the pane that reflected the ray before the hit; negative if none.
};

/// Treatment of rays that a pane reflects. `lost`: they end there, as absorbed rays do. `followed`: they continue to
/// the first surface, unless another pane stops them. Light of emitters and sky at their hits is part of direct light
/// (`MirroredLight`): count it once.
enum class Mirrored { lost, followed };

/// Position of a hit.
inline Point place_of(const Scene& scene, const RayHit& hit, const Point& origin, const Vec3& direction) {
    const Point straight = origin + hit.distance * direction;
    if (hit.mirror < 0) return straight;
    const Pane& pane = scene.panes()[static_cast<std::size_t>(hit.mirror)];
    return straight - 2 * dot(pane.n, straight - pane.corners[0]) * pane.n;
}

/// Direction of the ray at the hit, or where it leaves the scene, after any reflection.
inline Vec3 arriving(const Scene& scene, const RayHit& hit, const Vec3& direction) {
    if (hit.mirror < 0) return direction;
    const Normal& n = scene.panes()[static_cast<std::size_t>(hit.mirror)].n;
    return direction - 2 * dot(n, direction) * n;
}

/// Sixteen ray end points, already lifted off their surfaces, in the tracer's coordinates: relative to the middle of
/// the scene's box, metres times the power of two that makes the scene about 1 wide, rotated (TracingFrame).
struct alignas(64) RayEnds {
    static constexpr std::size_t size = 16;
    float x[size], y[size], z[size];
};

/// Traces rays through a scene in packets, in single precision with coordinates relative to the scene's middle. Rays
/// that start on a region are lifted off its plane by 2^-20 of the scene's size, so that the region and its coplanar
/// neighbours never block them; below faces that are closer (`NarrowGaps`), they start lower, and double precision
/// decides whether they meet those faces. Otherwise the hit surface is found in single precision: within about 1e-7 of
/// the scene's size from an edge it may be the neighbour. The distance is that to the plane of the found surface, in
/// double precision. Rays from below such close faces end at panes that mirror them.
/// Thread-safe. Hits do not depend on the number of threads.
class RayTracer {
  public:
    /// The scene must outlive the tracer. 0.3-0.5 s and about 85 MB per million triangles.
    explicit RayTracer(const Scene& scene);
    ~RayTracer();
    RayTracer(RayTracer&&) noexcept;
    RayTracer& operator=(RayTracer&&) noexcept;

    /// Finds the first hit of each ray from one point of region `own` (none: a point in free space).
    /// directions  need not have length 1
    /// hits  same size as `directions`
    /// Returns the number of rays traced.
    std::size_t nearest(std::span<const Vec3> directions, const Point& origin, RegionId own, std::span<RayHit> hits,
                        Mirrored mirrored = Mirrored::lost) const;

    /// Like the above, with a separate origin on `own` for each ray; all three spans have the same size.
    std::size_t nearest(std::span<const Point> origins, std::span<const Vec3> directions, RegionId own,
                        std::span<RayHit> hits, Mirrored mirrored = Mirrored::lost) const;

    /// Like the above, from points of any regions. From a diffusing pane, rays start on the side of the given region.
    std::size_t nearest(std::span<const RayEnd> origins, std::span<const Vec3> directions, std::span<RayHit> hits,
                        Mirrored mirrored = Mirrored::lost) const;

    /// Tests for occlusion: blocked[i] is set to whether anything is between from[i] on region `receiver` and to[i] on
    /// region `source` (either may be none). Both regions must face each other there. All three spans have the same
    /// size. Returns the number of rays traced. Fastest if consecutive rays are close together, like those of one link.
    std::size_t occluded(std::span<const Point> from, std::span<const Point> to, RegionId receiver, RegionId source,
                         std::span<bool> blocked) const;

    /// Like the above, between points of any regions.
    std::size_t occluded(std::span<const RayEnd> from, std::span<const RayEnd> to, std::span<bool> blocked) const;

    /// Converts sixteen points of a region for the occluded() below.
    RayEnds ray_ends(std::span<const Point> points, RegionId region) const;

    /// Bit mask: bit k is set if anything is between points k of `from` and `to`. Use it if many rays share end points:
    /// preparing a packet then takes only a few instructions.
    std::uint32_t occluded(const RayEnds& from, const RayEnds& to) const;

    std::size_t triangle_count() const;

    /// Faces of planes in which faces have both orientations (`OpposedFaces`).
    std::span<const SurfaceId> opposed_faces() const;

  private:
    struct Content;
    std::unique_ptr<const Content> content_;
};

}  // namespace exitance
