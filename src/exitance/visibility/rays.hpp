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
};

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
    std::size_t nearest(std::span<const Vec3> directions, const Point& origin, RegionId own,
                        std::span<RayHit> hits) const;

    /// The same from a point of `own` a ray; all three are of one length.
    std::size_t nearest(std::span<const Point> origins, std::span<const Vec3> directions, RegionId own,
                        std::span<RayHit> hits) const;

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
