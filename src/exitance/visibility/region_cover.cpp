#include "exitance/visibility/region_cover.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace exitance {
namespace {

/// Convex hull, counter-clockwise (monotone chains [Andrew79]). Sorts the points.
void make_hull(std::vector<Vec2>& points, std::vector<Vec2>& hull) {
    std::sort(points.begin(), points.end(), [](Vec2 a, Vec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    hull.clear();
    const auto add = [&](Vec2 p, std::size_t keep) {
        while (hull.size() >= keep + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
            hull.pop_back();
        hull.push_back(p);
    };
    for (const Vec2& p : points) add(p, 0);
    const std::size_t lower = hull.size() - 1;
    for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
    hull.pop_back();
}

/// Returns whether part of the segment a b is inside a convex polygon by more than `margin`.
bool enters(Vec2 a, Vec2 b, std::span<const Vec2> polygon, double margin) {
    double from = 0, to = 1;
    for (std::size_t i = 0, m = polygon.size(); i < m; ++i) {
        const Vec2 edge = polygon[i + 1 == m ? 0 : i + 1] - polygon[i];
        const double least = margin * std::sqrt(dot(edge, edge));
        const double ha = cross(edge, a - polygon[i]) - least, hb = cross(edge, b - polygon[i]) - least;
        if (ha <= 0 && hb <= 0) return false;
        if (ha < 0) from = std::max(from, ha / (ha - hb));
        if (hb < 0) to = std::min(to, ha / (ha - hb));
    }
    return from < to;
}

}  // namespace

void RegionCover::begin(const Region& region, double margin) {
    region_ = &region;
    frame_ = Frame(region.plane.n);
    origin_ = region.loops[0][0];
    margin_ = margin, side_ = 0;
    crossings_.clear();
}

bool RegionCover::add(const Point& x, const Point& y) {
    double hx = dot(region_->plane.n, x - origin_), hy = dot(region_->plane.n, y - origin_);
    if (side_ == 0) side_ = hx - hy > 0 ? 1 : -1;
    hx *= side_, hy *= side_;
    if (hx < 0 || hy > 0 || hx - hy <= margin_) return false;
    crossings_.push_back(flat(x + (hx / (hx - hy)) * (y - x)));
    return true;
}

bool RegionCover::covers() {
    make_hull(crossings_, hull_);
    if (hull_.size() < 3) return false;
    Vec2 middle;
    for (const Vec2& p : hull_) middle = middle + (1.0 / static_cast<double>(hull_.size())) * p;
    bool holds_middle = false;
    for (const std::vector<Point>& loop : region_->loops) {
        Vec2 a = flat(loop.back());
        for (const Point& p : loop) {
            const Vec2 b = flat(p);
            if (enters(a, b, hull_, margin_)) return false;
            if ((a.y > middle.y) != (b.y > middle.y) && middle.x - a.x < (b.x - a.x) * ((middle.y - a.y) / (b.y - a.y)))
                holds_middle = !holds_middle;
            a = b;
        }
    }
    return holds_middle;
}

}  // namespace exitance
