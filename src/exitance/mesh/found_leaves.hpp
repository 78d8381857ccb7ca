#pragma once

#include <span>
#include <vector>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// The result of make_conforming for the leaves of one plane: how they are split, and their nodes. Uses few arrays
/// because there is one object per plane and processes exchange them.
struct FoundLeaves {
    std::uint32_t node_count = 0;
    std::vector<ElementId> leaf;
    std::vector<std::uint32_t> places, nodes;  ///< Per leaf: how many entries of `place` and of `node` belong to it.
    std::vector<Vec2> place;  ///< Points of each fan: apex, then border. Leaves that stay whole have none.
    /// Nodes of each leaf. For a fan: of the apex, then of the border. Otherwise: of the leaf's corners.
    std::vector<std::uint32_t> node;

    /// Adds a leaf; it stays whole if the fan has no border.
    void add(ElementId e, const Fan& fan, std::span<const std::uint32_t> of_leaf) {
        leaf.push_back(e);
        places.push_back(static_cast<std::uint32_t>(fan.border.empty() ? 0 : 1 + fan.border.size()));
        nodes.push_back(static_cast<std::uint32_t>(of_leaf.size()));
        if (places.back() > 0) place.push_back(fan.apex);
        place.insert(place.end(), fan.border.begin(), fan.border.end());
        node.insert(node.end(), of_leaf.begin(), of_leaf.end());
    }

    /// Numbers of the resulting fans, of their triangles, and of the corners of these and of whole leaves.
    struct Counts {
        std::size_t fans = 0, triangles = 0, corners = 0;
    };
    void count(Counts& out) const {
        for (std::size_t k = 0; k < leaf.size(); ++k) {
            const std::size_t of_fan = places[k] == 0 ? 0 : places[k] - 2;
            out.fans += of_fan > 0, out.triangles += of_fan;
            out.corners += of_fan > 0 ? 3 * of_fan : nodes[k];
        }
    }
};

}  // namespace exitance
