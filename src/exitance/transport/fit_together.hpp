#pragma once

#include <functional>
#include <vector>

#include "exitance/transport/direct_fit.hpp"

namespace exitance {

/// True if direct light can be fitted on many small elements at once (`fit_together`).
bool may_fit_together(const Stage& stage);

/// Fits direct light on small elements of a crowd by rays that start all over them, with a constant each: their light
/// varies less than its noise unless the border of a sun's shadow crosses them. Neighbouring elements are processed
/// together, so that rays of a packet are similar. Writes `fit` of the elements that were fitted, and returns the
/// others in the given order: larger ones, those that a sun lights in part, and sides of panes. Collective. minor_area
/// limit on the area of elements that are fitted, m^2 noise_on    noise that an element may have
std::vector<ElementId> fit_together(const Stage& stage, const ElementTree& tree, const std::vector<ElementId>& elements,
                                    double minor_area, const std::function<NoiseAllowed(ElementId)>& noise_on,
                                    Field<ElementId, DirectFit>& fit, const StopRequest& stop);

}  // namespace exitance
