#include "exitance/view_factors/convex_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "exitance/scene/borders.hpp"

namespace exitance {
namespace {

constexpr double min_width = 16;  ///< Width of a part, in units of the slack; derived from the rounding of corners.
constexpr std::size_t max_corners = 12;  ///< Limit on the corners of a convex part.

/// Returns the plane through an edge and perpendicular to the polygon's plane, with the polygon in front.
Plane side_plane(const Point& a, const Point& b, const Normal& n) {
    const Normal inwards = normalized(cross(n, b - a));
    return {inwards, dot(inwards, a)};
}

/// Subtracts the holes one by one. The middle one along the polygon comes first, so that each of the remaining parts
/// has only about half of the others.
class Subtraction {
  public:
    Subtraction(std::span<const std::span<const Point>> holes, const Normal& n, double slack, ConvexParts& parts)
        : holes_(holes), n_(n), slack_(slack), parts_(parts) {
        for (const std::span<const Point> hole : holes) boxes_.push_back(box_of(hole));
    }

    void operator()(std::span<const Point> polygon) {
        std::vector<std::uint32_t> all(holes_.size());
        for (std::uint32_t h = 0; h < all.size(); ++h) all[h] = h;
        cut(polygon, std::move(all));
    }

  private:
    /// `hidden_by`: indices of the holes that may overlap the polygon.
    void cut(std::span<const Point> polygon, std::vector<std::uint32_t> hidden_by) {
        const Box box = box_of(polygon);
        std::erase_if(hidden_by, [&](std::uint32_t h) {
            return !may_overlap(boxes_[h], box) || is_negligible(intersection(polygon, holes_[h], n_), slack_);
        });
        if (hidden_by.empty()) return add_parts(polygon, parts_);
        const std::uint32_t middle = take_middle(box, hidden_by);
        const std::span<const Point> hole = holes_[middle];
        std::vector<Point> rest(polygon.begin(), polygon.end()), outside, next;
        for (std::size_t i = 0; i < hole.size() && rest.size() >= 3; ++i) {
            const Point &a = hole[i], &b = hole[(i + 1) % hole.size()];
            if (!(norm(b - a) > 0)) continue;
            const Plane inside = side_plane(a, b, n_);
            clip(rest, {-inside.n, -inside.offset}, outside);
            if (!is_negligible(outside, slack_)) cut(outside, hidden_by);
            clip(rest, inside, next);
            rest.swap(next);
        }
    }

    /// True if two boxes overlap, projected along the axis on which the normal is largest.
    bool may_overlap(const Box& a, const Box& b) const {
        std::size_t normal_axis = std::abs(n_.x) >= std::abs(n_.y) ? 0 : 1;
        if (std::abs(n_.z) > std::abs(n_[normal_axis])) normal_axis = 2;
        for (std::size_t k = 0; k < 3; ++k)
            if (k != normal_axis && (a.lo[k] > b.hi[k] || b.lo[k] > a.hi[k])) return false;
        return true;
    }

    /// Removes and returns the hole that is in the middle along the longest side of a box.
    std::uint32_t take_middle(const Box& box, std::vector<std::uint32_t>& some) const {
        const Vec3 size = box.hi - box.lo;
        std::size_t axis = size.x >= size.y ? 0 : 1;
        if (size.z > size[axis]) axis = 2;
        const auto middle = some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2);
        std::nth_element(some.begin(), middle, some.end(), [&](std::uint32_t g, std::uint32_t h) {
            const double at_g = boxes_[g].lo[axis] + boxes_[g].hi[axis], at_h = boxes_[h].lo[axis] + boxes_[h].hi[axis];
            return at_g < at_h || (at_g == at_h && g < h);
        });
        const std::uint32_t taken = *middle;
        some.erase(middle);
        return taken;
    }

    std::span<const std::span<const Point>> holes_;
    const Normal& n_;
    double slack_;
    ConvexParts& parts_;
    std::vector<Box> boxes_;
};

}  // namespace

void add_parts(std::span<const Point> polygon, ConvexParts& parts) {
    for (std::size_t first = 1; first + 1 < polygon.size(); first += max_corners - 2) {
        std::vector<Point>& part = parts.emplace_back();
        part.push_back(polygon[0]);
        for (std::size_t k = first; k < polygon.size() && k < first + max_corners - 1; ++k) part.push_back(polygon[k]);
    }
}

bool is_negligible(std::span<const Point> polygon, double slack) {
    return polygon.size() < 3 || norm(area_vector(polygon)) <= min_width * slack * box_of(polygon).diagonal();
}

std::vector<Point> intersection(std::span<const Point> a, std::span<const Point> b, const Normal& n) {
    std::vector<Point> part(a.begin(), a.end()), next;
    for (std::size_t i = 0; i < b.size() && part.size() >= 3; ++i) {
        const Point &from = b[i], &to = b[(i + 1) % b.size()];
        if (!(norm(to - from) > 0)) continue;
        clip(part, side_plane(from, to, n), next);
        part.swap(next);
    }
    return part;
}

void subtract(std::span<const Point> polygon, std::span<const std::span<const Point>> holes, const Normal& n,
              double slack, ConvexParts& parts) {
    Subtraction(holes, n, slack, parts)(polygon);
}

}  // namespace exitance
