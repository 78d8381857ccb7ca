#pragma once

#include <array>
#include <vector>

#include "exitance/mesh/element_locator.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Casts rays that leave an element as diffuse light does: spread over its area, with density cos / pi around its
/// normal, at scrambled Sobol points. The element gathers light from the surfaces that they hit first; read in the
/// other direction, these are the surfaces that receive its light. One object serves one thread.
class ElementRays {
  public:
    static constexpr std::uint32_t missed = 0xffffffffu;

    /// Side by which rays leave an element of a diffusing pane: `front` is the element's own side, as for the light
    /// that it sends; `as_met` chooses a side for the light that it gathers (`met_directions`).
    enum class Leave : std::uint8_t { front, as_met };

    /// `tree`, whose leaves `locator` finds, and all other arguments must outlive the object.
    ElementRays(const Stage& stage, const ElementTree& tree, const ElementLocator& locator)
        : stage_(stage), tree_(tree), locator_(locator) {}

    /// Casts leaves.size() rays and writes for each the number of the leaf whose front it hits, or `missed`. Uses the
    /// points of sequence `key` from number `first` on. If `counts` is given (one number per ray), half of the rays are
    /// aimed at openings where that reduces the noise (`PortalAim`), and counts[k] becomes the weight of ray k. If
    /// `colours` is given, colours[k] becomes the colour that panes give to ray k (`GlassColours`). Returns the number
    /// of rays that hit neither fronts nor backs, those that a pane stopped included.
    std::size_t cast(ElementId e, std::uint64_t key, std::span<std::uint32_t> leaves, std::uint32_t first = 0,
                     Leave leave = Leave::front, std::span<float> counts = {}, std::span<Spectrum> colours = {});

  private:
    void aim(RegionId region, const Normal& n, const Point& centre, std::span<float> counts);

    const Stage& stage_;
    const ElementTree& tree_;
    const ElementLocator& locator_;
    std::array<std::vector<double>, 4> coordinates_;  ///< Coordinates of the rays' sample points.
    std::vector<Point> origins_;
    std::vector<Vec3> directions_;
    std::vector<RayHit> hits_;
    std::vector<LeafFinder::Query> queries_;
    std::vector<std::size_t> of_ray_;
};

}  // namespace exitance
