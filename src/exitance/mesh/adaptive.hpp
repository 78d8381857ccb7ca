#pragma once

#include <array>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// Cuts a leaf that is found too coarse: a parallelogram across its longer direction, or both where they are alike; a
/// triangle into four; a cell across its longest extent. Returns its children. `only`: the one direction that a
/// parallelogram is to be cut across (`sufficient_cut`).
IdRange<ElementId> refine_element(ElementTree& tree, ElementId leaf, Cut only = Cut::none);

/// The one direction across which a parallelogram is cut if what its misfit, a mean square, keeps without its part
/// along that direction is `allowed`; Cut::none where neither is enough. Between slats, and along edges where walls
/// meet, light varies along one direction alone, and elements that follow both would be many times as many.
Cut sufficient_cut(double misfit_squared, const std::array<double, 2>& along, double allowed_squared);

}  // namespace exitance
