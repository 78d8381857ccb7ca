#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/geometry/polygon.hpp"

namespace exitance {

/// The area that two outlines of one plane have in common, m^2; 0 when it is no more than corners that are off by
/// `tolerance` (metres) can make it. Convex pieces are clipped by each other: O(corners) for convex outlines.
double common_area(std::span<const Point> a, std::span<const Point> b, const Normal& n, double tolerance);

/// The extent of an outline in a plane's own coordinates.
struct FlatBox {
    Vec2 lo{HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL};

    void add(const Vec2& p) {
        lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
    bool overlaps(const FlatBox& o, double tolerance) const {
        return std::min(hi.x, o.hi.x) - std::max(lo.x, o.lo.x) > tolerance &&
               std::min(hi.y, o.hi.y) - std::max(lo.y, o.lo.y) > tolerance;
    }
};

/// Calls meet(i, j), i < j, for every two boxes that overlap by more than `tolerance` both ways. A sweep along x:
/// O(n log n) and what is side by side.
template <class Meet>
void each_overlap(std::span<const FlatBox> boxes, double tolerance, const Meet& meet) {
    std::vector<std::uint32_t> order(boxes.size()), open;
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return boxes[a].lo.x != boxes[b].lo.x ? boxes[a].lo.x < boxes[b].lo.x : a < b;
    });
    for (std::uint32_t i : order) {
        std::erase_if(open, [&](std::uint32_t o) { return boxes[o].hi.x <= boxes[i].lo.x; });
        for (std::uint32_t o : open)
            if (boxes[o].overlaps(boxes[i], tolerance)) meet(std::min(o, i), std::max(o, i));
        open.push_back(i);
    }
}

}  // namespace exitance
