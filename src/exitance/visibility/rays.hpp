#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// What a ray meets first.
struct RayHit {
    SurfaceId surface;                                          ///< None when nothing is met.
    RegionId region;                                            ///< That of the surface.
    double distance = std::numeric_limits<double>::infinity();  ///< In lengths of the ray's direction.
    bool front = false;                                         ///< Is it the surface's front that is met?
    std::int32_t mirror = -1;  ///< The pane that has mirrored the ray on its way; none below 0.
};

/// What becomes of rays that a pane mirrors: they are lost, as all that panes stop, or go on and are met where they
/// arrive, unless another pane stops them. Direct light knows no mirrors, so that light of emitters and of the sky that
/// comes by one is to be left out by who follows them.
enum class Mirrored { lost, followed };

/// Where a ray has met something.
inline Point place_of(const Scene& scene, const RayHit& hit, const Point& origin, const Vec3& direction) {
    const Point straight = origin + hit.distance * direction;
    if (hit.mirror < 0) return straight;
    const Pane& pane = scene.panes()[static_cast<std::size_t>(hit.mirror)];
    return straight - 2 * dot(pane.n, straight - pane.corners[0]) * pane.n;
}

/// The direction in which it arrives there, or leaves the scene.
inline Vec3 arriving(const Scene& scene, const RayHit& hit, const Vec3& direction) {
    if (hit.mirror < 0) return direction;
    const Normal& n = scene.panes()[static_cast<std::size_t>(hit.mirror)].n;
    return direction - 2 * dot(n, direction) * n;
}

/// A point of a region; of free space where that is none.
struct SurfacePoint {
    Point at;
    RegionId region;
};

/// Sixteen places off the surfaces that they belong to, as rays begin and end there: metres from the middle of
/// the scene's box, times the power of two that makes the scene about 1 wide.
struct alignas(64) RayEnds {
    static constexpr std::size_t size = 16;
    float x[size], y[size], z[size];
};

/// Rays through a scene, many at a time: single precision inside, on coordinates relative to the scene's middle. Rays
/// that start on a region are lifted off its plane by a few roundings (2^-20 of the scene's size), so neither it nor
/// its coplanar neighbours are ever in the way. Which surface is met is decided in single precision, so within about
/// 1e-7 of the scene's size beside an edge it may be the neighbour; the distance is to the plane of that surface, in
/// double precision. Safe to use from any number of threads. The same rays give the same hits on any number of threads.
class RayTracer {
  public:
    /// The scene must outlive it. 0.3-0.5 s and about 85 MB a million triangles.
    explicit RayTracer(const Scene& scene);
    ~RayTracer();
    RayTracer(RayTracer&&) noexcept;
    RayTracer& operator=(RayTracer&&) noexcept;

    /// The first surface along each ray from one point of region `own` (none: a point of free space). Directions need
    /// not have length 1. `hits` is as long as `directions`. Returns how many rays were traced.
    std::size_t nearest(std::span<const Vec3> directions, const Point& origin, RegionId own, std::span<RayHit> hits,
                        Mirrored mirrored = Mirrored::lost) const;

    /// The same from a point of `own` a ray; all three are of one length.
    std::size_t nearest(std::span<const Point> origins, std::span<const Vec3> directions, RegionId own,
                        std::span<RayHit> hits, Mirrored mirrored = Mirrored::lost) const;

    /// blocked[i]: does anything stand between from[i] on region `receiver` and to[i] on region `source` (either may be
    /// none)? Both regions must face each other there. All three spans are of one length. Returns how many rays were
    /// traced. Rays that share their ends' neighbourhood, as those of one link do, are fastest.
    std::size_t occluded(std::span<const Point> from, std::span<const Point> to, RegionId receiver, RegionId source,
                         std::span<bool> blocked) const;

    /// The same between points of any regions.
    std::size_t occluded(std::span<const SurfacePoint> from, std::span<const SurfacePoint> to,
                         std::span<bool> blocked) const;

    /// Sixteen points of a region, for `occluded` below.
    RayEnds ray_ends(std::span<const Point> points, RegionId region) const;

    /// Bit k: does anything stand between places k of both? For ends that many rays share: a packet is made in a few
    /// instructions.
    std::uint32_t occluded(const RayEnds& from, const RayEnds& to) const;

    std::size_t triangle_count() const;

  private:
    struct Content;
    std::unique_ptr<const Content> content_;
};

}  // namespace exitance
