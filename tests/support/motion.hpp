#pragma once

#include "exitance/base/vec.hpp"

namespace exitance {

/// Scales, turns and moves points of a test scene. Results may not depend on it.
struct Motion {
    double scale = 1;
    Vec3 u{1, 0, 0}, v{0, 1, 0}, n{0, 0, 1}, by;

    Vec3 turned(const Vec3& d) const { return d.x * u + d.y * v + d.z * n; }
    Point operator()(const Point& p) const { return by + scale * turned(p); }
};

inline const Motion as_written, turned_and_moved{0.03, {0.6, 0, 0.8}, {0, 1, 0}, {-0.8, 0, 0.6}, {7, -30, 11}};

}  // namespace exitance
