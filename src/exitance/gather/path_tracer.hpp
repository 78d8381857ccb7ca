#pragma once

#include <optional>

#include "exitance/base/random.hpp"
#include "exitance/gather/light_choice.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Follows paths of light from the place where it arrives [Kajiya86]. The direct light at a vertex is the sum of
///
/// 1. one shadow ray to an emitter (`LightChoice`),
/// 2. one ray to each distant disc,
/// 3. emission and sky that the path's next ray meets, straight or mirrored by panes, and
/// 4. one mirror image, in a pane, of the sun or of a light without extent.
///
/// The balance heuristic [Veach95] weights 1 and 3. Paths end by Russian roulette with the reflectance as survival. The
/// stage must outlive the tracer.
class PathTracer {
  public:
    /// A point of a path where light is reflected.
    struct Vertex {
        SurfacePoint at;
        Spectrum colour;  ///< Factors of the panes between this point and the one before (`GlassColours`).
    };
    /// Result of one step of a path at a vertex.
    struct Step {
        Spectrum direct;             ///< One unbiased sample of the direct irradiance at the vertex, W/m^2.
        std::optional<Vertex> next;  ///< Hit of the next ray, chosen with density cos / pi; none if no front is hit.
    };

    explicit PathTracer(const Stage& stage);

    /// Returns one unbiased sample of the irradiance at `probe` by light that surfaces have reflected, W/m^2. a, b in
    /// [0, 1) choose the direction of the path's first ray.
    Spectrum path(const SurfacePoint& probe, double a, double b, RandomStream& random) const;

    /// Casts a ray from `from` and returns the vertex where it hits a front; none if it hits nothing or a back. Panes
    /// may mirror the ray. a, b in [0, 1) choose its direction, with density cos / pi around the normal.
    std::optional<Vertex> first(const SurfacePoint& from, double a, double b) const;

    /// Takes a step from `y`. On a diffusing pane, it starts from one of the two sides, chosen in proportion to the
    /// share of the light leaving `y` that arrived on that side.
    Step step(const SurfacePoint& y, RandomStream& random) const;

    /// Approximate number of rays per step. Rays to lights without extent and to mirror images are not counted.
    double rays_per_step() const;

  private:
    RayHit trace(const SurfacePoint& from, const Vec3& direction, Mirrored mirrored) const;
    /// Returns the vertex of a hit; none if nothing or a back is hit.
    std::optional<SurfacePoint> vertex_of(const RayHit& hit, const SurfacePoint& from, const Vec3& direction) const;
    Spectrum met_light(const RayHit& hit, const SurfacePoint& from, const Vec3& direction) const;
    Spectrum light_of_discs(const SurfacePoint& y, RandomStream& random) const;
    double weight_of_shadow_ray(const SurfacePoint& y, const SurfacePoint& target) const;
    Spectrum shadow_ray(const SurfacePoint& y, RandomStream& random) const;

    const Stage& stage_;
    LightChoice lights_;
};

}  // namespace exitance
