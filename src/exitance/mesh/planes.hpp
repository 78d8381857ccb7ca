#pragma once

#include <vector>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// Groups regions into planes, i.e. receiving surfaces regardless of material: coplanar regions that face the same way
/// and are not stacked on one another. Returns the plane's number per region; numbers start at 0, in the order of the
/// regions.
Field<RegionId, std::uint32_t> plane_of_regions(const Scene& scene);

/// Leaves of every plane, in the order of their ids.
std::vector<std::vector<ElementId>> leaves_of_planes(const ElementTree& tree,
                                                     const Field<RegionId, std::uint32_t>& plane);

}  // namespace exitance
