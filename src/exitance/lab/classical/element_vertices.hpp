#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "exitance/mesh/element_tree.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Vertices of elements as in [Wallace89]: all elements of a region with a corner at one point share a vertex.
struct ElementVertices {
    std::vector<Point> at;  ///< Moved slightly into an element, so that surfaces at its border do not block.
    std::vector<RegionId> region;
    std::vector<std::vector<std::uint32_t>> of_element;  ///< Vertices around each element, in the order of `add`.

    /// Adds elements, and those of their vertices that do not exist yet.
    void add(const Stage& stage, const ElementTree& tree, std::span<const ElementId> elements);

  private:
    /// Per region and grid cell.
    std::map<std::tuple<std::uint32_t, long long, long long, long long>, std::uint32_t> known_;
};

}  // namespace exitance
