#pragma once

#include <vector>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// Regions by the surface that they are to arriving light, whatever they are made of: those in one plane that face one
/// way and do not lie on one another. Numbers from 0 on, in the order of the regions.
Field<RegionId, std::uint32_t> plane_of_regions(const Scene& scene);

/// Leaves by their plane, in the order of their ids.
std::vector<std::vector<ElementId>> leaves_of_planes(const ElementTree& tree,
                                                     const Field<RegionId, std::uint32_t>& plane);

}  // namespace exitance
