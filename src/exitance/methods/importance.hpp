#pragma once

#include <vector>

#include "exitance/solution/solution.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/solve/solve_options.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Where the light is looked at: points per area, by leaf number, relative to their mean over all surfaces. A point in
/// free space stands for what its hemisphere meets. The right-hand side w_0 of the adjoint equation w = w_0 + F (rho
/// w), whose solution says how much an error of the irradiance counts [Smits92]. O(points).
std::vector<Spectrum> looked_at(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                                const std::vector<ImportantPoint>& points, std::uint64_t seed);

/// The points that lie on surfaces, as places of a function's elements.
std::vector<ElementTree::Place> places_of(const Stage& stage, const ElementTree& tree,
                                          const std::vector<ImportantPoint>& points);

}  // namespace exitance
