#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "exitance/direct/direct_light.hpp"
#include "exitance/form_factors/point_to_polygon_batch.hpp"
#include "exitance/mesh/element_tree.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Separates the strong sources of direct light of an element from the weak ones, whose light it estimates by rays. For
/// buildings, in which hundreds of emitters shine through doors on thousands of small objects and exact visibility of
/// most of them would be too expensive.
///
///     E of weak sources ~ sum of  M_s A_s / n_s sum over n_s rays of  K(x_i, y_i) V(x_i, y_i),    E[n_s] = n w_s,
///
/// between points x_i of the element and y_i of the source, K = cos cos / (pi r^2). w_s is the share of s in the
/// unoccluded light at the element's centre. If n w_s < 1, a random decision casts one ray or none, and the ray is
/// weighted by 1 / (n w_s): the estimate is unbiased. One object per thread.
class SampledLight {
  public:
    /// `direct` and `tracer` must outlive this object.
    SampledLight(const DirectLight& direct, const RayTracer& tracer, std::uint64_t seed);

    struct Estimate {
        Spectrum weak;              ///< Light of all weak sources together, W/m^2.
        double misfit_squared = 0;  ///< Mean of (w (E - weak))^2 caused by the weak sources, w the weight.
        std::vector<DirectLight::SourceName> strong;  ///< Sources whose visibility must be computed exactly.
    };
    /// Treats the largest number of sources as weak that together cause a misfit of at most `allowed`, weighted by
    /// `weight`. They share n = `rays` rays, at most `most_rays`. About 30 ns per source, plus the rays.
    const Estimate& operator()(const ElementTree& tree, ElementId e, const Spectrum& weight, double allowed,
                               unsigned rays);
    static constexpr unsigned most_rays = 1024;

  private:
    struct Source {
        DirectLight::SourceName name;
        RegionId region;
        double F;        ///< Unoccluded form factor from the element's centre, weighted by relative radiance.
        double area;     ///< m^2
        Spectrum light;  ///< Unoccluded light at the centre.
        double share;    ///< Share of the unoccluded light of all sources.
        /// (radii / distance)^2: relative variation of the source's light over the element and the source.
        double near;
        /// Visible light: all of it if some visibility ray arrived, scaled so that the mean over elements is unbiased.
        Spectrum in_sight;
        unsigned rays;   ///< Rays cast for the current purpose, 0 or more.
        double arrived;  ///< Sum of K V over these rays, 1/m^2.
    };
    struct Ray {
        double kernel;  ///< cos cos / (pi r^2), 1/m^2
        std::uint32_t source;
    };
    /// Sort key of sources, the weakest first: the visible light, then its possible variation.
    struct Rank {
        double in_sight, astray;
        std::uint32_t source;

        auto operator<=>(const Rank&) const = default;
    };
    void find_sources(const Point& x, const Normal& n, RegionId own, double radius);
    /// Purpose of rays; each has independent random points.
    enum class Purpose : std::uint64_t { sight, value };
    /// Adds `rays` rays from the element to a source to a batch that is traced together, which fills the ray packets.
    void add_rays(const ElementTree& tree, ElementId e, std::uint32_t source, unsigned rays, Purpose purpose);
    void trace_rays();

    const DirectLight& direct_;
    const RayTracer& tracer_;
    std::uint64_t seed_;
    QuadBatch quads_;           ///< All pieces of all emitters, in order.
    std::vector<double> area_;  ///< Areas of the pieces in `quads_`, m^2.
    std::vector<double> F_;     ///< Unoccluded form factor of each piece from the current point.
    std::vector<Source> sources_;
    std::vector<Rank> ranks_;
    Estimate estimate_;
    std::vector<SurfacePoint> from_, to_;
    std::vector<Ray> rays_;
};

}  // namespace exitance
