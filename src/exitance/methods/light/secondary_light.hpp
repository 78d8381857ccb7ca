#pragma once

#include <optional>
#include <span>
#include <vector>

#include "exitance/discontinuity/receiver_curves.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/solve/discontinuity_choice.hpp"
#include "exitance/visibility/glazed_part.hpp"

namespace exitance {

/// Regions by the power that they reflect, the most first: as many as are asked for. Each is cut along its own
/// elements, and quarters of these, where what it reflects varies by more than half of the most, the part with the
/// largest difference of power first, until none does or there are 64 parts. Light is looked at at nine places a piece
/// or element. Empty, or of fewer sources, where `stop` is requested.
std::vector<SecondarySource> secondary_sources(const Stage& stage, const Solution& solution,
                                               const ElementLocator& locator, const SecondarySources& asked,
                                               const StopRequest& stop);

/// Shadows that the light of some surfaces throws, for places where reflected light is known from elements alone:
///
///     E(x) = E_e(x) - (H(x) - H_e(x)),    H(x) = sum over sources and their parts of  B_part F(x, hidden part),
///
/// E_e the light of the elements, H_e what such elements make of H: a polynomial each, made continuous as E_e was.
/// Where nothing stands before a source it changes nothing. H is exact for parts of even light. Where there are panes,
/// which H does not see through, nothing changes either; nothing falls below 0.
class SecondaryLight {
  public:
    /// All but `sources` must outlive it. Where `stop` is requested before it is made it has no effect. O(leaves x
    /// sources).
    SecondaryLight(const Stage& stage, const ElementFunction& elements, const ElementLocator& locator,
                   std::vector<SecondarySource> sources, const StopRequest& stop);

    /// E, W/m^2, at a place of a region.
    Spectrum at(RegionId region, const Point& x) const;

    struct Workspace {
        VisibilityWorkspace visibility;
        Fragments fragments;
        std::vector<Vec3> whole, part, next;
    };
    /// H alone.
    Spectrum hidden(RegionId region, const Point& x, Workspace& scratch) const;

  private:
    Spectrum light_of(const SecondarySource& source, std::span<const Vec3> polygon, const Receiver& at,
                      Workspace& scratch) const;
    void fit_elements(const StopRequest& stop);
    void fit_element(ElementFunction& fit, ElementId e, Workspace& scratch) const;

    const Stage& stage_;
    const ElementFunction& elements_;
    const ElementLocator& locator_;
    std::vector<SecondarySource> sources_;
    ElementFunction fit_;                        ///< H_e.
    std::optional<ElementLocator> fit_locator_;  ///< None: of no effect.
};

}  // namespace exitance
