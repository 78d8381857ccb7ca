#pragma once

#include <vector>

#include "exitance/transport/stage.hpp"

namespace exitance {

/// Mean direct irradiance of every leaf, W/m^2, by leaf number: exact visibility at stratified points of the leaf, the
/// more the larger it is (`points` for a leaf of mean area, at least one). O(points x visible emitters).
std::vector<Spectrum> project_direct_light(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                                           double points, std::uint64_t seed);

}  // namespace exitance
