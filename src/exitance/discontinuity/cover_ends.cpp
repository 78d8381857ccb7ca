#include "exitance/discontinuity/cover_ends.hpp"

#include <algorithm>

namespace exitance {
namespace {

/// Appends the segment where a convex outline crosses a height of `level` above a plane, if it does. `heights`: heights
/// of its corners, metres.
void add_crossing(std::span<const Point> outline, std::span<const double> heights, double level,
                  std::vector<std::pair<Point, Point>>& out) {
    Point ends[2];
    std::size_t count = 0;
    for (std::size_t i = 0, m = outline.size(); i < m && count < 2; ++i) {
        const std::size_t j = (i + 1) % m;
        if ((heights[i] > level) == (heights[j] > level)) continue;
        const double t = (level - heights[i]) / (heights[j] - heights[i]);
        ends[count++] = outline[i] + t * (outline[j] - outline[i]);
    }
    if (count == 2) out.emplace_back(ends[0], ends[1]);
}

/// All points at most `reach` away from a region's bounding box, metres.
ConvexRegion around(const Region& region, double reach) {
    Box box;
    for (const auto& loop : region.loops)
        for (const Point& p : loop) box.add(p);
    ConvexRegion out;
    for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
        out.add({axis, dot(axis, box.lo) - reach}), out.add({-axis, -dot(axis, box.hi) - reach});
    return out;
}

}  // namespace

std::vector<std::pair<Point, Point>> cover_ends(const Occluders& occluders, RegionId number) {
    const Region& region = occluders.scene().regions()[number];
    const double lift = occluders.lift(number);
    std::vector<std::pair<Point, Point>> out;
    std::vector<double> heights;
    const auto look = [&](PieceId p) {
        const ConvexPiece& piece = occluders.pieces()[p];
        if (occluders.is_own(piece.region, number)) return false;
        // Steeper faces cross the plane within 1e-4 of the scene's size; their contact lines are enough.
        constexpr double steepest = 0.01;  // sine, derived from coplanar_share / 1e-4
        if (norm(cross(piece.plane.n, region.plane.n)) > steepest) return false;
        heights.clear();
        for (const Point& c : occluders.corners(p)) heights.push_back(region.plane.signed_distance(c) - lift);
        const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
        // A face parallel to the plane up to rounding has no meaningful crossing.
        if (*high - *low <= 4 * occluders.rounding()) return false;
        for (const double level : {-piece.thickness, 0.0, piece.thickness})
            if (level != 0 || dot(piece.plane.n, region.plane.n) > 0)
                add_crossing(occluders.corners(p), heights, level, out);
        return false;
    };
    const ConvexRegion near = around(region, 2 * coplanar_share * occluders.scene().size());
    for (const Occluders::Size size : {Occluders::Size::large, Occluders::Size::small})
        occluders.visit_region(size, near, look, region.plane.n);
    return out;
}

}  // namespace exitance
