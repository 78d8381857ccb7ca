#pragma once

#include <functional>

#include "exitance/basis/element_fit.hpp"
#include "exitance/links/link_sites.hpp"
#include "exitance/methods/methods.hpp"

namespace exitance {

// Light at the nodes of a hierarchy's elements, as a method hands it on.

/// The mean of a function over an element.
Spectrum mean_over(const LinkSites& sites, const NodalValues& values, ElementId e);

/// The polynomial of an element as files and rays hold it: linear or bilinear, nearest in the mean square.
ElementFit fit_polynomial(const LinkSites& sites, const NodalValues& values, ElementId e);

/// A function on elements, be they held or below those that are.
using NodalLight = std::function<NodalValues(ElementId)>;

/// Those of `elements` whose function is further than `allowed` from that polynomial, RMS of rho E, W/m^2.
std::vector<ElementId> rough_elements(const LinkSites& sites, const NodalLight& E,
                                      const std::vector<ElementId>& elements, double allowed);

/// Direct light as it was projected, at the nodes of a leaf, which the projection's leaves are or hold.
NodalValues projected_light(const LinkSites& sites, const DirectProjection& projection, ElementId leaf);

/// Writes direct and indirect light of every leaf, means and corners, and what it reflects of them, to `light`.
void write_nodal_light(const LinkSites& sites, const NodalLight& indirect, const DirectProjection& projection,
                       GlobalLight& light);

}  // namespace exitance
