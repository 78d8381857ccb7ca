#pragma once

#include <vector>

#include "exitance/solution/solution.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/solve/solve_options.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Importance at the points where light is wanted: points per area, by leaf number, relative to their mean over all
/// surfaces. A point in free space counts as the surface points that rays over its hemisphere hit. This is the
/// right-hand side w_0 of the adjoint equation w = w_0 + F (rho w), whose solution weights errors of the irradiance
/// [Smits92]. O(points).
std::vector<Spectrum> importance_at(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                                    const std::vector<ImportantPoint>& points, std::uint64_t seed);

/// Returns the element and coordinates of every point that is on a surface.
std::vector<ElementTree::Place> places_of(const Stage& stage, const ElementTree& tree,
                                          const std::vector<ImportantPoint>& points);

}  // namespace exitance
