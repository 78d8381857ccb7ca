#pragma once

#include <array>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// Splits a leaf that is too coarse: a parallelogram across its longer direction, or across both if their lengths are
/// within a ratio of 3 : 2; a triangle into four; a cell across its longest extent.
/// only  if not Cut::none, the only direction across which a parallelogram is split (see sufficient_cut)
/// Returns the children.
IdRange<ElementId> refine_element(ElementTree& tree, ElementId leaf, Cut only = Cut::none);

/// Returns the single direction across which to split a parallelogram: Cut::u or Cut::v if removing the part of the
/// error that varies along that direction leaves at most `allowed_squared`; Cut::none if neither does. Between slats,
/// and along edges where walls meet, light varies in one direction only; splitting in both would make many more
/// elements.
/// misfit_squared  mean square error
/// along  the parts of it that vary along u and along v
Cut sufficient_cut(double misfit_squared, const std::array<double, 2>& along, double allowed_squared);

}  // namespace exitance
