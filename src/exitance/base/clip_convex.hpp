#pragma once

#include <span>
#include <vector>

namespace exitance {

/// Clips a convex polygon to the part where a linear function of position is at least 0. `Vector` has two or three
/// components. Replaces `out` by the part, which may have fewer than three corners. O(corners).
template <class Vector, class Height>
void clip_convex(std::span<const Vector> polygon, const Height& height, std::vector<Vector>& out) {
    out.clear();
    for (std::size_t i = 0, m = polygon.size(); i < m; ++i) {
        const Vector &p = polygon[i], &q = polygon[i + 1 == m ? 0 : i + 1];
        const double a = height(p), b = height(q);
        if (a >= 0) out.push_back(p);
        if ((a > 0 && b < 0) || (a < 0 && b > 0)) out.push_back(p + (a / (a - b)) * (q - p));
    }
}

}  // namespace exitance
