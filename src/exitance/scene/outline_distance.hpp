#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Returns the point of an outline's border that is nearest to p, metres. O(corners).
inline Point nearest_on_border(std::span<const Point> outline, const Point& p) {
    Point best = outline[0];
    double least = HUGE_VAL;
    for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
        const Vec3 edge = outline[i] - outline[j], w = p - outline[j];
        const double along = std::clamp(dot(w, edge) / squared_norm(edge), 0.0, 1.0);
        const double distance = squared_norm(w - along * edge);
        if (distance < least) least = distance, best = outline[j] + along * edge;
    }
    return best;
}

}  // namespace exitance
