#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include "exitance/mesh/element_tree.hpp"
#include "exitance/transport/direct_light.hpp"
#include "exitance/transport/form_factor_batch.hpp"
#include "exitance/transport/visibility.hpp"

namespace exitance {

/// Which sources of direct light count on an element, and what all the others bring: rays find it. In buildings, where
/// hundreds of emitters shine through doors on thousands of small things, exact answers about most of them would cost
/// more than they are worth.
///
///     E of weak sources ~ sum of  M_s F(x, s) V_s,      V_s the share of n_s rays, E[n_s] = 16 w_s,
///
/// x being the element's middle and w_s the part of s in the light as if nothing stood in it. Where 16 w_s < 1, chance
/// decides on a ray, which then counts 1 / (16 w_s) times: the mean over many elements is right. One object serves one
/// thread.
class SampledLight {
  public:
    /// Both must outlive it.
    SampledLight(const DirectLight& direct, const RayTracer& tracer, std::uint64_t seed);

    struct Estimate {
        Spectrum weak;                                ///< Of weak sources together, W/m^2.
        double misfit_squared = 0;                    ///< Mean of (w (E - weak))^2 that these may leave.
        std::vector<DirectLight::SourceName> strong;  ///< To be looked at well.
    };
    /// As many sources are weak as together leave no more than `allowed` for the misfit, by weight w. About 30 ns a
    /// source, and 32 rays.
    const Estimate& operator()(const ElementTree& tree, ElementId e, const Spectrum& weight, double allowed);

  private:
    struct Source {
        DirectLight::SourceName name;
        RegionId region;
        Spectrum light;     ///< As if nothing stood in between.
        double expected;    ///< Rays.
        double near;        ///< (radii / distance)^2: how much its light varies over the two, as part of it.
        Spectrum in_sight;  ///< All of it where some ray of its own got through, in the mean over elements.
    };
    /// What sources are ordered by, the weakest first: what is in sight of them, then how far they may be astray.
    struct Rank {
        double in_sight, astray;
        std::uint32_t source;

        auto operator<=>(const Rank&) const = default;
    };
    void find_sources(const Point& x, const Normal& n, RegionId own, double radius);
    /// The part of its light that a source sends, by an own set of rays for each purpose; 0 if no ray was drawn.
    double visible_part(const ElementTree& tree, ElementId e, std::size_t source, std::uint64_t purpose);

    const DirectLight& direct_;
    const RayTracer& tracer_;
    std::uint64_t seed_;
    QuadBatch quads_;        ///< All pieces of all emitters, one after the other,
    std::vector<double> F_;  ///< and what a place gets of each, could it see it.
    std::vector<Source> sources_;
    std::vector<Rank> ranks_;
    Estimate estimate_;
    std::vector<Point> from_, to_;
};

}  // namespace exitance
