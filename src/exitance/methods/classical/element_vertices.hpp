#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "exitance/mesh/element_tree.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Vertices of elements as [Wallace89] has them: one for all leaves of a region that have a corner there.
struct ElementVertices {
    std::vector<Point> at;  ///< Drawn a little into the elements, so that what stands on a border is no blocker.
    std::vector<RegionId> region;
    std::vector<std::vector<std::uint32_t>> of_leaf;  ///< Numbers of the vertices around what a leaf covers.

    /// Adds the vertices that only these leaves have; the others keep their numbers.
    void update(const Stage& stage, const ElementTree& tree, std::span<const ElementId> leaves);

  private:
    std::map<std::tuple<std::uint32_t, long long, long long, long long>, std::uint32_t> known_;  ///< By region, place.
};

}  // namespace exitance
