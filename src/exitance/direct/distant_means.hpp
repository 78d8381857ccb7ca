#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/base/direction_order.hpp"
#include "exitance/direct/direct_light.hpp"
#include "exitance/direct/distant_sources.hpp"
#include "exitance/direct/light_accuracy.hpp"
#include "exitance/direct/sky_tree.hpp"
#include "exitance/mesh/element_tree.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Mean direct light of small elements below an open sky and suns, by rays that start all over the elements. The rays
/// of many elements are traced together, sorted by direction: if the elements are neighbours, rays of a packet are
/// alike. This is for meshes of thousands of small faces, on each of which the light varies less than its noise.
///
/// The light of the sky, and of each sun, is its unoccluded light times the share of its rays that arrive, each ray
/// weighted by radiance times cosine over density (SkyTree, SeenPolygon). Each has rays of its own; they are doubled
/// while the noise is too large.
class DistantMeans {
  public:
    /// Both arguments must outlive this object.
    DistantMeans(const DirectLight& direct, const RayTracer& tracer);

    /// True if all light comes from an open sky and from suns, and nothing is transparent.
    static bool suits(const DirectLight& direct);

    /// Mean light of an element. It is not found if the border of a sun's shadow may cross the element, or if the
    /// element sees hardly any of the sky, at whose openings rays must be aimed.
    struct Mean {
        Spectrum irradiance;  ///< W/m^2
        double variance = 0;  ///< Mean over bands, (W/m^2)^2.
        bool is_found = false;
    };
    class Workspace;
    /// Finds the means of elements that are neighbours. Regions must not transmit light. About 0.1 us per ray.
    void find(const ElementTree& tree, std::span<const ElementId> elements, std::span<const LightAccuracy> accuracy,
              Workspace& room, std::span<Mean> out) const;

  private:
    struct Part;
    void find_parts(const ElementTree& tree, std::span<const ElementId> elements, Workspace& room) const;
    void add_rays(const ElementTree& tree, Part& part, std::uint32_t number, Workspace& room) const;
    void trace(Workspace& room) const;

    const DirectLight* direct_;
    const RayTracer* tracer_;
    SkyTree sky_;
    std::vector<DistantDisc> suns_;
    double reach_ = 0;  ///< Length of rays, beyond all surfaces, m.
};

/// Light of a sky or a sun on an element.
struct DistantMeans::Part {
    ElementId element;
    std::uint32_t index = 0;           ///< Position of the element in the call.
    const DistantDisc* sun = nullptr;  ///< Null: the sky.
    Spectrum open;                     ///< Light without occlusion, W/m^2.
    std::uint32_t rays = 0;            ///< Rays cast so far, a power of two.
    std::uint32_t wanted = 0;          ///< Rays to have after the next step.
    /// Sums of the weights of all rays, and of the rays that arrive. One entry per eighth of the rays; the spread of
    /// the eighths gives the variance.
    struct Sums {
        Spectrum all, arrived;
    };
    std::array<Sums, 8> eighth = {};

    Spectrum share() const;  ///< Share of the light that arrives.
    double variance() const;
};

/// Temporary storage; one per thread.
class DistantMeans::Workspace {
    friend DistantMeans;
    struct Ray {
        std::uint32_t part, eighth;
        Spectrum weight;
    };
    DirectLight::Workspace exact_;
    SkyTree::Aim aim_;
    std::vector<Part> parts_;  ///< Parts of an element are consecutive.
    std::vector<Ray> rays_;
    std::vector<RayEnd> from_, to_, sorted_from_, sorted_to_;
    std::vector<Vec3> ways_;
    std::array<std::vector<double>, 4> coordinates_;
    DirectionOrder order_;
    std::vector<std::uint8_t> blocked_;
};

}  // namespace exitance
