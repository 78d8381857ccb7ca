#pragma once

#include <cstddef>

namespace exitance {

/// How the n x n pairs of a link's nodes lie in its masks and blocks: node l of the source by node l, the first 4
/// (order 2) or 8 (order 3) nodes of the receiver beside each other, as lanes; then what is left, the receiver's last
/// node, against all of the source.
template <std::size_t lane_count, std::size_t node_count>
struct LinkLayout {
    static constexpr std::size_t lanes = lane_count, n = node_count;
    static constexpr bool has_rest = n > lanes;
    /// Of node k of the receiver and node l of the source.
    static constexpr std::size_t position(std::size_t k, std::size_t l) {
        return k < lanes ? l * lanes + k : lanes * n + l;
    }
};
using LinkLayout2 = LinkLayout<4, 4>;
using LinkLayout3 = LinkLayout<8, 9>;

}  // namespace exitance
