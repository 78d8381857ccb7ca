#pragma once

#include <span>

#include "exitance/base/polygon.hpp"

namespace exitance {

/// Bit 0: something in front of a plane; bit 1: something behind it.
inline int sides(std::span<const Point> points, const Plane& plane, double thickness) {
    int out = 0;
    for (const Point& p : points) {
        const double d = plane.signed_distance(p);
        out |= d > thickness ? 1 : d < -thickness ? 2 : 0;
    }
    return out;
}

inline Plane turned(const Plane& plane) {
    return {-plane.n, -plane.offset};
}

}  // namespace exitance
