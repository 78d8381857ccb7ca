#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/mesh/contact_lines.hpp"

namespace exitance {

/// Tests whether a segment is on a line of discontinuity.
class OnJump {
  public:
    OnJump(std::span<const ContactLines::Line> jumps, const Normal& n, const Point& in_plane, double tolerance)
        : tolerance_(tolerance) {
        std::vector<Box> boxes;
        const auto foot = [&](const Point& p) { return p - dot(p - in_plane, n) * n; };
        for (const ContactLines::Line& line : jumps) {
            lines_.push_back({foot(line.a), foot(line.b), line.height});
            boxes.emplace_back().add(lines_.back().a);
            boxes.back().add(lines_.back().b);
        }
        tree_ = Bvh(boxes);
    }

    /// Returns whether the segment a b follows such a line, or is shorter than the tolerance with both ends on it. Such
    /// short edges arise where neighbours were cut at slightly different places.
    /// `area`: of the smaller of the two adjacent elements, m^2.
    bool operator()(const Point& a, const Point& b, double area) const {
        if (lines_.empty()) return false;
        // Sine of the angle between a side and its line. Derived from both being cut along one line: only rounding
        // turns the side.
        constexpr double parallel = 1e-3;
        const Point middle = 0.5 * (a + b);
        const Vec3 around{tolerance_, tolerance_, tolerance_};
        Box box;
        box.add(middle - around), box.add(middle + around);
        return tree_.visit_box(box, [&](std::uint32_t i) {
            const Point &p = lines_[i].a, &q = lines_[i].b;
            const Vec3 d = q - p, side = b - a;
            if (lines_[i].height > std::max(tolerance_, ContactLines::height_of_jump(area))) return false;
            const auto is_near = [&](const Point& x) {
                const double at = std::clamp(dot(x - p, d) / squared_norm(d), 0.0, 1.0);
                return norm(x - p - at * d) <= tolerance_;
            };
            if (norm(side) <= tolerance_ && is_near(a) && is_near(b)) return true;
            return norm(cross(d, side)) <= parallel * norm(d) * norm(side) && is_near(middle);
        });
    }

  private:
    std::vector<ContactLines::Line> lines_;
    Bvh tree_;
    double tolerance_;
};

}  // namespace exitance
