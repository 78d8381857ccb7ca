#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "exitance/base/limits.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// Appends to `planes` the unit normals, pointing inwards, of the planes through the origin and the edges of a convex
/// polygon. `facing`: positive if the polygon is counter-clockwise as seen from the origin, negative if clockwise.
/// Returns false, and appends nothing, if the polygon is seen edge-on.
inline bool add_pyramid(std::span<const Vec3> polygon, double facing, std::vector<Vec3>& planes) {
    const std::size_t first = planes.size();
    for (std::size_t i = 0, m = polygon.size(); i < m; ++i) {
        const Vec3 &a = polygon[i], &b = polygon[i + 1 == m ? 0 : i + 1];
        const Vec3 normal = cross(b - a, a);
        const double squared = squared_norm(normal), reach = squared_norm(a) * squared_norm(b);
        if (squared > edge_on_sine * edge_on_sine * reach)
            planes.push_back(normal * (std::copysign(1.0, facing) / std::sqrt(squared)));
    }
    if (planes.size() < first + 3) {
        planes.resize(first);
        return false;
    }
    return true;
}

}  // namespace exitance
