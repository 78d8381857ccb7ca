#pragma once

#include <optional>

#include "exitance/base/random.hpp"
#include "exitance/gather/light_choice.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Follows paths of light from the place where it arrives [Kajiya86]. At every vertex the direct light is estimated by
/// one shadow ray to an emitter, chosen by its unoccluded contribution, by one ray to each distant disc, and by the
/// path's next ray (weighted by the balance heuristic [Veach95]; a lost ray sees the sky), which panes mirror. Sun and
/// lights without extent are also estimated by one of their mirror images in panes. Paths end by Russian
/// roulette with the reflectance as survival. The stage must outlive the tracer.
class PathTracer {
  public:
    /// A point that a path has reached.
    struct Vertex {
        Point x;
        Normal n;
        RegionId region;
    };

    /// Result of one step of a path at a vertex.
    struct Step {
        Spectrum direct;             ///< One unbiased sample of the direct irradiance at the vertex, W/m^2.
        std::optional<Vertex> next;  ///< Hit of a ray with density cos / pi; none if it hits no front.
    };

    explicit PathTracer(const Stage& stage);

    /// Returns one unbiased sample of the irradiance at `probe` that was reflected at least once, W/m^2. a, b in [0, 1)
    /// choose its first direction.
    Spectrum path(const Vertex& probe, double a, double b, RandomStream& random) const;

    /// Returns the vertex that a ray of density cos / pi from `from` reaches; none if it meets no front. Follows panes
    /// that mirror. a, b in [0, 1) choose its direction.
    std::optional<Vertex> first(const Vertex& from, double a, double b) const;

    /// Takes a step from `y`, from either side of a diffusing pane in proportion to the light that leaves `y` by it.
    Step step(const Vertex& y, RandomStream& random) const;

    /// Upper limit of the rays of a step.
    double rays_per_step() const;

  private:
    RayHit trace(const Vertex& from, const Vec3& direction, Mirrored mirrored) const;
    /// Returns the vertex of a hit; none if nothing or a back is hit.
    std::optional<Vertex> vertex_of(const RayHit& hit, const Vertex& from, const Vec3& direction) const;
    Spectrum met_light(const RayHit& hit, const Vertex& from, const Vec3& direction) const;
    Spectrum light_of_discs(const Vertex& y, RandomStream& random) const;
    double weight_of_shadow_ray(const Vertex& y, const Vertex& target) const;
    Spectrum shadow_ray(const Vertex& y, RandomStream& random) const;

    const Stage& stage_;
    LightChoice lights_;
};

}  // namespace exitance
