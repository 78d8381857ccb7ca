#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/base/polygon.hpp"

namespace exitance {

/// Area of the intersection of two outlines in one plane, m^2. Returns 0 if it is so small that corners displaced by
/// `tolerance` (metres) can explain it. Convex pieces are clipped by each other: O(corners) for convex outlines.
double common_area(std::span<const Point> a, std::span<const Point> b, const Normal& n, double tolerance);

/// Bounding box of an outline in coordinates of its plane.
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

/// Calls meet(i, j) for boxes i and j < i that overlap by more than `tolerance` in both directions, in a fixed order.
/// If meet returns true, continues with the next i. Returns true if it gave up because most boxes overlap most others:
/// after about eight calls or 256 steps per box. O(n log n).
template <class Meet>
bool each_overlap(std::span<const FlatBox> boxes, double tolerance, const Meet& meet) {
    std::vector<Box> solid(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
        solid[i].add(Point{boxes[i].lo.x, boxes[i].lo.y, 0}), solid[i].add(Point{boxes[i].hi.x, boxes[i].hi.y, 0});
    const Bvh tree(solid);
    std::size_t calls = 8 * boxes.size() + 100'000, steps = 32 * calls;
    for (std::uint32_t i = 0; i < boxes.size() && calls > 0 && steps > 0; ++i)
        tree.visit_box(solid[i], [&](std::uint32_t j) {
            if (--steps == 0) return true;
            if (j >= i || !boxes[i].overlaps(boxes[j], tolerance)) return false;
            return meet(i, j) || --calls == 0;
        });
    return calls == 0 || steps == 0;
}

}  // namespace exitance
