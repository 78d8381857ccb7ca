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

/// Returns the regions that reflect the most power, in descending order, up to the requested number. Each is divided
/// along its elements, and quarters of these, where its radiosity varies by more than half of the maximum. The part
/// with the largest difference of power is divided first, until none is left or there are 64 parts. Light is evaluated
/// at nine points per piece or element. Returns fewer sources, or none, if `stop` is requested.
std::vector<SecondarySource> secondary_sources(const Stage& stage, const Solution& solution,
                                               const ElementLocator& locator, const SecondarySources& asked,
                                               const StopRequest& stop);

/// Reflected light that is known on elements only, with sharp shadows of the light of some surfaces:
///
///     E(x) = E_e(x) - (H(x) - H_e(x)),    H(x) = sum over sources and their parts of  B_part F(x, hidden part),
///
/// where E_e is the light of the elements, and H_e approximates H by polynomials on such elements, made continuous as
/// E_e was. Unblocked sources change nothing. H is exact for parts of uniform radiosity. E is E_e if the scene has
/// panes, which H does not see through. Results are clamped at 0.
class SecondaryLight {
  public:
    /// All arguments except `sources` must outlive this object. If `stop` is requested during construction, it has no
    /// effect. O(leaves x sources).
    SecondaryLight(const Stage& stage, const ElementFunction& elements, const ElementLocator& locator,
                   std::vector<SecondarySource> sources, const StopRequest& stop);

    /// E at a point of a region, W/m^2.
    Spectrum at(RegionId region, const Point& x) const;

    struct Workspace {
        VisibilityWorkspace visibility;
        Fragments fragments;
        std::vector<Vec3> whole, part, next;
    };
    /// H only.
    Spectrum hidden(RegionId region, const Point& x, Workspace& scratch) const;

  private:
    Spectrum light_of(const SecondarySource& source, std::span<const Vec3> polygon, const SurfacePoint& at,
                      Workspace& scratch) const;
    void fit_elements(const StopRequest& stop);
    void fit_element(ElementFunction& fit, ElementId e, Workspace& scratch) const;

    const Stage& stage_;
    const ElementFunction& elements_;
    const ElementLocator& locator_;
    std::vector<SecondarySource> sources_;
    ElementFunction fit_;                        ///< H_e.
    std::optional<ElementLocator> fit_locator_;  ///< Locator in `fit_`; none if a stop prevented the fit.
};

}  // namespace exitance
