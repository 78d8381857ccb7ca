#pragma once

#include <algorithm>
#include <cmath>

#include "exitance/base/spectrum.hpp"
#include "exitance/mesh/element_locator.hpp"

namespace exitance {

constexpr int patch_sweeps = 3;  ///< Maximum number of refinement sweeps of substructuring.

/// Threshold of refinement: substructuring splits an element if its reflected light differs from that of a neighbour by
/// more than this, W/m^2.
constexpr double steep_step(double error, double mean_light) {
    return 8 * error * mean_light;
}

/// Largest difference of light between a leaf and its neighbours in the same region, W/m^2. `light(e)`: light of a
/// leaf, W/m^2.
template <class Light>
double steepest_step(const ElementTree& tree, const ElementLocator& locator, ElementId leaf, const Light& light) {
    const Patch& patch = tree.patch(leaf);
    const double own = light(leaf);
    double steepest = 0;
    const Point centre = patch.centre();
    for (int i = 0; i < patch.corner_count(); ++i) {
        const Point middle = 0.5 * (patch.corner(i) + patch.corner((i + 1) % patch.corner_count()));
        const Point across =
            // derived from neighbours of half the size: the point is inside any of them
            centre + 1.25 * (middle - centre);
        steepest = std::max(steepest, std::abs(own - light(locator.find(tree.region(leaf), across).element)));
    }
    return steepest;
}

}  // namespace exitance
