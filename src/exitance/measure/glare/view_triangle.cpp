#include "exitance/measure/glare/view_triangle.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/visibility/glazed_part.hpp"

namespace exitance {
namespace {

double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(norm(cross(a, b)), dot(a, b));
}

/// Returns the point of the segment from a to b that halves its angle.
Vec3 halfway(const Vec3& a, const Vec3& b) {
    const double la = norm(a), lb = norm(b);
    return (lb * a + la * b) / (la + lb);
}

/// Halves the longest edge until the triangle is small enough. Slivers give fewer parts than they would if all edges
/// were halved.
void cut(const ViewTriangle& t, double max_extent, int depth, std::vector<ViewTriangle>& out) {
    constexpr int max_depth = 24;
    std::size_t longest = 0;
    double most = 0;
    for (std::size_t k = 0; k < 3; ++k)
        if (const double angle = angle_between(t.corners[k], t.corners[(k + 1) % 3]); angle > most)
            most = angle, longest = k;
    if (most <= max_extent || depth >= max_depth) return out.push_back(t);
    const Vec3 &a = t.corners[longest], &b = t.corners[(longest + 1) % 3], &c = t.corners[(longest + 2) % 3];
    const Vec3 middle = halfway(a, b);
    cut({{a, middle, c}}, max_extent, depth + 1, out);
    cut({{middle, b, c}}, max_extent, depth + 1, out);
}

}  // namespace

double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double la = norm(a), lb = norm(b), lc = norm(c);
    const double below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    return std::abs(2 * std::atan2(dot(a, cross(b, c)), below));
}

double ViewTriangle::extent() const {
    return std::max({angle_between(corners[0], corners[1]), angle_between(corners[1], corners[2]),
                     angle_between(corners[2], corners[0])});
}

std::array<ViewTriangle, 4> ViewTriangle::quarters() const {
    const auto& [a, b, c] = corners;
    const Vec3 ab = halfway(a, b), bc = halfway(b, c), ca = halfway(c, a);
    return {ViewTriangle{{a, ab, ca}}, ViewTriangle{{ab, b, bc}}, ViewTriangle{{ca, bc, c}},
            ViewTriangle{{ab, bc, ca}}};
}

void add_view_triangles(std::span<const Vec3> polygon, double max_extent, std::vector<ViewTriangle>& out) {
    for (std::size_t k = 2; k < polygon.size(); ++k) {
        const ViewTriangle whole{{polygon[0], polygon[k - 1], polygon[k]}};
        if (whole.solid_angle() > 0) cut(whole, max_extent, 0, out);
    }
}

std::vector<std::vector<ViewTriangle>> visible_triangles(const Occluders& occluders, const SurfacePoint& eye,
                                                         std::span<const PieceId> pieces, double max_extent) {
    std::vector<std::vector<ViewTriangle>> out(pieces.size());
    parallel_ranges(pieces.size(), 16, [&](std::size_t begin, std::size_t end) {
        VisibilityWorkspace workspace;
        Fragments fragments;
        for (std::size_t i = begin; i < end; ++i) {
            fragments.clear();
            visible_fragments(occluders, eye, pieces[i], {}, workspace, fragments);
            for (const std::vector<Vec3>& fragment : fragments) add_view_triangles(fragment, max_extent, out[i]);
        }
    });
    return out;
}

}  // namespace exitance
