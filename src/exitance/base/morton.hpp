#pragma once

#include <algorithm>
#include <cstdint>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Returns the position of a point on a Morton curve through a box, 20 bits per axis. Points outside of the box count
/// as on its border. Sorting by it brings points near one another together.
inline std::uint64_t morton(const Point& p, const Box& box) {
    constexpr int bits = 20;
    constexpr double cells = (1 << bits) - 1;
    const auto spread = [](std::uint64_t v) {  // two zero bits after each bit
        v = (v | v << 32) & 0x001f00000000ffffu;
        v = (v | v << 16) & 0x001f0000ff0000ffu;
        v = (v | v << 8) & 0x100f00f00f00f00fu;
        v = (v | v << 4) & 0x10c30c30c30c30c3u;
        return (v | v << 2) & 0x1249249249249249u;
    };
    std::uint64_t out = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double extent = box.hi[axis] - box.lo[axis];
        const double at = extent > 0 ? std::clamp((p[axis] - box.lo[axis]) / extent, 0.0, 1.0) : 0;
        out |= spread(static_cast<std::uint64_t>(at * cells)) << axis;
    }
    return out;
}

}  // namespace exitance
