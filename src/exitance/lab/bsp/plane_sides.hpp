#pragma once

#include <span>

#include "exitance/base/polygon.hpp"

namespace exitance {

/// Returns bit 0 if any point is in front of the plane, bit 1 if any is behind it.
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
