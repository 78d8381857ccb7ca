#pragma once

#include <functional>

#include "exitance/basis/element_fit.hpp"
#include "exitance/links/link_sites.hpp"
#include "exitance/methods/methods.hpp"

namespace exitance {

// Light at the nodes of a hierarchy's elements, in the form that methods return.

/// Mean of a function over an element.
Spectrum mean_over(const LinkSites& sites, const NodalValues& values, ElementId e);

/// Least-squares fit of the linear or bilinear polynomial that files and rays use for an element.
ElementFit fit_polynomial(const LinkSites& sites, const NodalValues& values, ElementId e);

/// Reduces the slopes of an element's linear or bilinear polynomial, given at its corners, such that the polynomial is
/// negative nowhere on the element. The value at the centre, the mean of a linear one, is kept. A polynomial that is
/// fitted to a step is negative next to it, and rays into a dark corner read little else.
void keep_positive(const ElementTree& tree, ElementId e, std::array<Spectrum, 4>& corners);

/// A function on elements, including those below elements with coefficients.
using NodalLight = std::function<NodalValues(ElementId)>;

/// Returns those of `elements` whose function differs from that polynomial by more than `allowed`, RMS of rho E, W/m^2.
std::vector<ElementId> rough_elements(const LinkSites& sites, const NodalLight& E,
                                      const std::vector<ElementId>& elements, double allowed);

/// Projected direct light at the nodes of a leaf, which is a leaf of the projection or part of one.
NodalValues projected_light(const LinkSites& sites, const DirectProjection& projection, ElementId leaf);

/// Writes direct and indirect light of every leaf (means and corners) and the reflected light to `light`.
void write_nodal_light(const LinkSites& sites, const NodalLight& indirect, const DirectProjection& projection,
                       GlobalLight& light);

}  // namespace exitance
