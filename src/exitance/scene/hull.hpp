#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/base/triangulation.hpp"
#include "exitance/scene/borders.hpp"

namespace exitance {

/// A closed surface, given as triangles with their fronts inside.
class Hull {
  public:
    void add(const Triangle& t) { triangles_.push_back(t); }
    void finish() {
        std::vector<Box> boxes;
        for (const Triangle& t : triangles_) boxes.push_back(box_of(t));
        tree_ = Bvh(boxes);
        for (const Box& box : boxes) all_.add(box);
    }

    /// True if the surface winds about a point. Rays in three directions must agree.
    bool winds_about(const Point& x) const {
        constexpr std::array<Vec3, 3> ways{
            Vec3{0.5361, 0.3217, 0.7803}, {-0.7193, 0.5881, 0.3697}, {0.2719, -0.8017, 0.5323}};
        return std::all_of(ways.begin(), ways.end(), [&](const Vec3& way) { return crossings(x, way) > 0; });
    }

    /// True if the surface intersects a triangle over more than `slack` (metres).
    bool crosses(const Triangle& t, double slack) const {
        return tree_.visit_box(box_of(t), [&](std::uint32_t i) { return runs_through(t, triangles_[i], slack); });
    }

  private:
    /// Returns the number of fronts minus the number of backs that a ray from x meets.
    int crossings(const Point& x, const Vec3& way) const {
        int sum = 0;
        const Vec3 d = (2 * all_.diagonal() + norm(x - all_.centre())) * way;
        tree_.visit_segment(x, d, 1, [&](std::uint32_t i) {
            sum += side_that_is_crossed(triangles_[i], x, d);
            return 1.0;
        });
        return sum;
    }

    /// Returns 1 if the segment from x along d crosses the front of a triangle, -1 for its back, else 0.
    static int side_that_is_crossed(const Triangle& t, const Point& x, const Vec3& d) {
        const Vec3 a = t[0] - x, b = t[1] - x, c = t[2] - x;
        const double ab = dot(d, cross(a, b)), bc = dot(d, cross(b, c)), ca = dot(d, cross(c, a));
        const bool front = ab > 0 && bc > 0 && ca > 0, back = ab < 0 && bc < 0 && ca < 0;
        if (!front && !back) return 0;
        const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
        return dot(n, a) * dot(n, d) > 0 ? (dot(n, d) < 0 ? 1 : -1) : 0;
    }

    static bool runs_through(const Triangle& t, const Triangle& of, double slack) {
        const Vec3 area = cross(of[1] - of[0], of[2] - of[0]);
        if (!(norm(area) > 0)) return false;
        const Normal n = normalized(area);
        std::array<double, 3> h;
        for (std::size_t i = 0; i < 3; ++i) h[i] = dot(n, t[i] - of[0]);
        if (*std::min_element(h.begin(), h.end()) >= -slack || *std::max_element(h.begin(), h.end()) <= slack)
            return false;
        std::vector<Point> ends;  // end points of the intersection of t with the plane
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t k = (i + 1) % 3;
            if (h[i] == 0) ends.push_back(t[i]);
            if (h[i] * h[k] < 0) ends.push_back(t[i] + (h[i] / (h[i] - h[k])) * (t[k] - t[i]));
        }
        if (ends.size() < 2) return false;
        double from = 0, to = 1;
        const Vec3 along = ends[1] - ends[0];
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 edge = of[(i + 1) % 3] - of[i], inward = normalized(cross(n, edge));
            const double at = dot(inward, ends[0] - of[i]) - slack, more = dot(inward, along);
            if (more == 0 && at < 0) return false;
            if (more > 0) from = std::max(from, -at / more);
            if (more < 0) to = std::min(to, -at / more);
        }
        return (to - from) * norm(along) > slack;
    }

    std::vector<Triangle> triangles_;
    Bvh tree_;
    Box all_;
};

/// Triangulates an outline, counter-clockwise seen from the side to which n points.
inline std::vector<Triangle> triangles_of(std::span<const Point> outline, const Normal& n) {
    std::vector<Triangle> out;
    for (const auto& t : triangulate(outline, n)) out.push_back({outline[t[0]], outline[t[1]], outline[t[2]]});
    return out;
}

}  // namespace exitance
