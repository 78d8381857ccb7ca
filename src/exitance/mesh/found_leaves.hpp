#pragma once

#include <span>
#include <vector>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// The leaves of a plane as make_conforming finds them, side by side: what they are cut to, and their nodes. Few
/// arrays, since there are as many of these as planes, and processes tell them to one another.
struct FoundLeaves {
    std::uint32_t node_count = 0;
    std::vector<ElementId> leaf;
    std::vector<std::uint32_t> places, nodes;  ///< Of a leaf, how many of these are its own:
    std::vector<Vec2> place;                   ///< of a fan, its apex and its border; of a leaf that stays, none,
    std::vector<std::uint32_t> node;           ///< and of the apex, then of the border; of the leaf's corners.

    /// A fan without a border: the leaf stays.
    void add(ElementId e, const Fan& fan, std::span<const std::uint32_t> of_leaf) {
        leaf.push_back(e);
        places.push_back(static_cast<std::uint32_t>(fan.border.empty() ? 0 : 1 + fan.border.size()));
        nodes.push_back(static_cast<std::uint32_t>(of_leaf.size()));
        if (places.back() > 0) place.push_back(fan.apex);
        place.insert(place.end(), fan.border.begin(), fan.border.end());
        node.insert(node.end(), of_leaf.begin(), of_leaf.end());
    }

    /// What is made of them: fans, their triangles, and corners of these and of leaves that stay.
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
