#pragma once

#include <optional>
#include <vector>

#include "exitance/core/random.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Paths of light, followed from where it arrives [Kajiya86]. At every vertex the direct light is estimated by one
/// shadow ray, to an emitter chosen by its unoccluded contribution (one more to each
/// distant disc; skies are what lost rays see), and by the path's next ray, weighted by the balance
/// heuristic [Veach95]; paths end by Russian roulette with the reflectance as survival. The stage must outlive it.
class PathTracer {
  public:
    /// A point that a path has reached.
    struct Vertex {
        Point x;
        Normal n;
        RegionId region;
        bool mirrored = false;  ///< By a pane on the way: what emits there is left out, as direct light leaves it out.
    };

    explicit PathTracer(const Stage& stage);

    /// What one path brings to x of light that was reflected at least once, W/m^2: unbiased. a, b in [0, 1) choose its
    /// first direction.
    Spectrum path(const Vertex& probe, double a, double b, RandomStream& random) const;

  private:
    /// A piece of an emitter that shadow rays are aimed at.
    struct LightPiece {
        RegionId region;
        Patch patch;
        Normal n;
        double area;
        Spectrum exitance;
        RelativeRadiance radiance;
    };

    /// `lost`, if given, is set where a ray meets nothing that no pane has mirrored.
    std::optional<Vertex> follow(const Vertex& from, const Vec3& direction, bool* lost = nullptr,
                                 Mirrored mirrored = Mirrored::lost) const;
    Spectrum light_of_discs(const Vertex& y, RandomStream& random) const;
    double chances(const Vertex& y, std::vector<double>& chance) const;
    double shadow_density(const Vertex& y, const Vertex& target) const;
    double weight_of_shadow_ray(const Vertex& y, const Vertex& target) const;
    Spectrum shadow_ray(const Vertex& y, RandomStream& random) const;

    const Stage& stage_;
    std::vector<LightPiece> lights_;
};

}  // namespace exitance
