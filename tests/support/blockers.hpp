#pragma once

#include <vector>

#include "exitance/visibility/convex_blockers.hpp"

namespace exitance::test {

/// A convex polygon that blocks from both sides.
inline ConvexBlocker sheet(const std::vector<Point>& outline) {
    const Normal n = normalized(area_vector(outline));
    return make_sheet(outline, {n, dot(n, outline[0])});
}

/// A closed body of six faces. The bits of a corner's index are its x, y and z; `shear` moves the upper corners
/// (metres).
inline ConvexBlocker box(const Point& lo, const Point& hi, const Vec3& shear = {}) {
    ConvexBlocker body;
    for (int i = 0; i < 8; ++i)
        body.points.push_back(Point{i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z} +
                              (i & 4 ? shear : Vec3{}));
    body.loops = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& loop : body.loops) {
        const Normal n =
            normalized(cross(body.points[loop[1]] - body.points[loop[0]], body.points[loop[2]] - body.points[loop[1]]));
        body.faces.push_back({n, dot(n, body.points[loop[0]])});
    }
    for (std::size_t f = 0; f < 6; ++f)
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t g = 0; g < 6; ++g)
                for (std::size_t j = 0; j < 4; ++j) {
                    const std::uint32_t a = body.loops[f][i], b = body.loops[f][(i + 1) % 4];
                    if (a < b && body.loops[g][j] == b && body.loops[g][(j + 1) % 4] == a)
                        body.edges.push_back({a, b, static_cast<std::int32_t>(f), static_cast<std::int32_t>(g)});
                }
    return body;
}

}  // namespace exitance::test
