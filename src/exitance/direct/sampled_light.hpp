#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "exitance/direct/direct_light.hpp"
#include "exitance/form_factors/point_to_polygon_batch.hpp"
#include "exitance/mesh/element_tree.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Which sources of direct light count on an element, and what all the others bring: rays find it. In buildings, where
/// hundreds of emitters shine through doors on thousands of small things, exact answers about most of them would cost
/// more than they are worth.
///
///     E of weak sources ~ sum of  M_s A_s / n_s sum over n_s rays of  K(x_i, y_i) V(x_i, y_i),    E[n_s] = n w_s,
///
/// between places x_i of the element and y_i of the source, K = cos cos / (pi r^2), and w_s the part of s in the light
/// of the element's middle as if nothing stood in it. Where n w_s < 1, chance decides on a ray, which then counts 1 /
/// (n w_s) times: the mean is right. One object serves one thread.
class SampledLight {
  public:
    /// Both must outlive it.
    SampledLight(const DirectLight& direct, const RayTracer& tracer, std::uint64_t seed);

    struct Estimate {
        Spectrum weak;                                ///< Of weak sources together, W/m^2.
        double misfit_squared = 0;                    ///< Mean of (w (E - weak))^2 that these may leave.
        std::vector<DirectLight::SourceName> strong;  ///< To be looked at well.
    };
    /// As many sources are weak as together leave no more than `allowed` for the misfit, by weight w; they share n =
    /// `rays` rays, at most `most_rays`. About 30 ns a source, and the rays.
    const Estimate& operator()(const ElementTree& tree, ElementId e, const Spectrum& weight, double allowed,
                               unsigned rays);
    static constexpr unsigned most_rays = 1024;

  private:
    struct Source {
        DirectLight::SourceName name;
        RegionId region;
        double F;           ///< From the element's middle, as if nothing stood in between, by relative radiance.
        double area;        ///< m^2
        Spectrum light;     ///< At the middle.
        double share;       ///< In the light of all sources, as if nothing stood in between.
        double near;        ///< (radii / distance)^2: how much its light varies over the two, as part of it.
        Spectrum in_sight;  ///< All of it where some ray of its own got through, in the mean over elements.
        unsigned rays;      ///< Of the purpose at hand, 0 or more,
        double arrived;     ///< and the sum of K V over them, 1/m^2.
    };
    struct Ray {
        double kernel;  ///< cos cos / (pi r^2), 1/m^2
        std::uint32_t source;
    };
    /// What sources are ordered by, the weakest first: what is in sight of them, then how far they may be astray.
    struct Rank {
        double in_sight, astray;
        std::uint32_t source;

        auto operator<=>(const Rank&) const = default;
    };
    void find_sources(const Point& x, const Normal& n, RegionId own, double radius);
    /// What rays are for: each has a set of its own.
    enum class Purpose : std::uint64_t { sight, value };
    /// So many rays from the element to a source, to be traced with those of the others: packets of rays are filled.
    void add_rays(const ElementTree& tree, ElementId e, std::uint32_t source, unsigned rays, Purpose purpose);
    void trace_rays();

    const DirectLight& direct_;
    const RayTracer& tracer_;
    std::uint64_t seed_;
    QuadBatch quads_;           ///< All pieces of all emitters, one after the other,
    std::vector<double> area_;  ///< their areas, m^2,
    std::vector<double> F_;     ///< and what a place gets of each, could it see it.
    std::vector<Source> sources_;
    std::vector<Rank> ranks_;
    Estimate estimate_;
    std::vector<SurfacePoint> from_, to_;
    std::vector<Ray> rays_;
};

}  // namespace exitance
