#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "exitance/mesh/element_tree.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Vertices of elements as [Wallace89] has them: one for all elements of a region that have a corner there.
struct ElementVertices {
    std::vector<Point> at;  ///< Drawn a little into the elements, so that surfaces on a border do not block.
    std::vector<RegionId> region;
    std::vector<std::vector<std::uint32_t>> of_element;  ///< Vertices around each element, in the order of `add`.

    /// Adds elements, and the vertices that none of the earlier ones has.
    void add(const Stage& stage, const ElementTree& tree, std::span<const ElementId> elements);

  private:
    std::map<std::tuple<std::uint32_t, long long, long long, long long>, std::uint32_t> known_;  ///< By region, place.
};

}  // namespace exitance
