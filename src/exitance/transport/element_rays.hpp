#pragma once

#include <array>
#include <vector>

#include "exitance/mesh/element_locator.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Rays that leave an element as diffuse light does: spread over its area, density cos / pi around its normal, at
/// scrambled Sobol points. What they hit first is what the element gathers from, and, read the other way round, where
/// its light goes. One object serves one thread.
class ElementRays {
  public:
    static constexpr std::uint32_t missed = 0xffffffffu;

    /// By which sides rays leave a diffusing pane: by the element's own, as its light does, or as what it gathers from
    /// asks for (`met_directions`).
    enum class Leave : std::uint8_t { front, as_met };

    /// `tree`, over which `locator` finds leaves, and all else must outlive it.
    ElementRays(const Stage& stage, const ElementTree& tree, const ElementLocator& locator)
        : stage_(stage), tree_(tree), locator_(locator) {}

    /// Writes for each ray the number of the leaf whose front it hits, or `missed`. The rays are named by `key`; they
    /// are as many of its points from number `first` on. With `counts`, as many as rays, half of the rays are aimed at
    /// openings where that is worth it (`PortalAim`), and each counts as so many.
    void cast(ElementId e, std::uint64_t key, std::span<std::uint32_t> leaves, std::uint32_t first = 0,
              Leave leave = Leave::front, std::span<float> counts = {});

  private:
    void aim(RegionId region, const Normal& n, const Point& centre, std::span<float> counts);

    const Stage& stage_;
    const ElementTree& tree_;
    const ElementLocator& locator_;
    std::array<std::vector<double>, 4> coordinates_;  ///< Of the points that name the rays.
    std::vector<Point> origins_;
    std::vector<Vec3> directions_;
    std::vector<RayHit> hits_;
    std::vector<LeafFinder::Query> queries_;
    std::vector<std::size_t> of_ray_;
};

}  // namespace exitance
