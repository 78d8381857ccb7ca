#pragma once

#include <cstddef>

namespace exitance {

/// Layout of the n x n pairs of a link's nodes in its masks and blocks. For each node l of the source, the first 4
/// (order 2) or 8 (order 3) nodes of the receiver are consecutive, as lanes. The pairs of the receiver's last node
/// (order 3) with all nodes of the source follow.
template <std::size_t lane_count, std::size_t node_count>
struct LinkLayout {
    static constexpr std::size_t lanes = lane_count, n = node_count;
    static constexpr bool has_rest = n > lanes;
    /// Index of the pair of node k of the receiver and node l of the source.
    static constexpr std::size_t position(std::size_t k, std::size_t l) {
        return k < lanes ? l * lanes + k : lanes * n + l;
    }
};
using LinkLayout2 = LinkLayout<4, 4>;
using LinkLayout3 = LinkLayout<8, 9>;

}  // namespace exitance
