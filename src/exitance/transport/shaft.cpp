#include "exitance/transport/shaft.hpp"

#include <algorithm>

namespace exitance {
namespace {

Point mean(std::span<const Point> points) {
    Vec3 sum;
    for (const Point& p : points) sum += p - points[0];
    return points[0] + sum / static_cast<double>(points.size());
}

double highest(std::span<const Point> points, const Plane& plane) {
    double h = -HUGE_VAL;
    for (const Point& p : points) h = std::max(h, plane.signed_distance(p));
    return h;
}

/// Convex hull, counter-clockwise (monotone chains [Andrew79]); orders the points.
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

/// Does a part of the segment a b lie inside a convex polygon by more than `margin`?
bool enters(Vec2 a, Vec2 b, std::span<const Vec2> polygon, double margin) {
    double from = 0, to = 1;
    for (std::size_t i = 0, m = polygon.size(); i < m; ++i) {
        const Vec2 edge = polygon[i + 1 == m ? 0 : i + 1] - polygon[i];
        const double length = std::sqrt(dot(edge, edge));
        const double ha = cross(edge, a - polygon[i]) - margin * length,
                     hb = cross(edge, b - polygon[i]) - margin * length;
        if (ha <= 0 && hb <= 0) return false;
        if (ha < 0) from = std::max(from, ha / (ha - hb));
        if (hb < 0) to = std::min(to, ha / (ha - hb));
    }
    return from < to;
}

}  // namespace

void Shaft::clip_by(const Plane& plane, std::vector<Point>& polygon) {
    clip(polygon, plane, buffer_);
    std::swap(polygon, buffer_);
}

void Shaft::set(const Occluders& occluders, const Facet& receiver, const Facet& source) {
    occluders_ = &occluders;
    receiver_region_ = receiver.region, source_region_ = source.region;
    blocker_ = PieceId();
    receiver_plane_ = {receiver.n, dot(receiver.n, receiver.corners[0])};
    source_plane_ = {source.n, dot(source.n, source.corners[0])};
    receiver_.assign(receiver.corners.begin(), receiver.corners.end());
    source_.assign(source.corners.begin(), source.corners.end());
    const double slack = occluders.rounding();
    planes_.clear();
    if (highest(receiver_, source_plane_) <= slack || highest(source_, receiver_plane_) <= slack) {
        receiver_.clear();
        return;
    }
    clip_by(source_plane_, receiver_);
    clip_by(receiver_plane_, source_);
    if (receiver_.empty() || source_.empty()) return;
    planes_.push_back(receiver_plane_);
    planes_.push_back(source_plane_);
    add_supporting_planes(receiver_, source_);
    add_supporting_planes(source_, receiver_);
    region_.clear();
    for (Plane& plane : planes_) {
        plane.offset += slack;  // what only touches the shaft is outside
        region_.add(plane);
    }
}

void Shaft::add_supporting_planes(std::span<const Point> edges, std::span<const Point> corners) {
    const double slack = occluders_->rounding();
    for (std::size_t i = 0, m = edges.size(); i < m; ++i) {
        const Point &a = edges[i], &b = edges[i + 1 == m ? 0 : i + 1];
        for (const Point& c : corners) {
            Vec3 normal = cross(b - a, c - a);
            const double length = norm(normal);
            if (length <= 1e-12 * norm(b - a) * norm(c - a) || length == 0) continue;  // c stands in line with the edge
            normal *= 1 / length;
            double low = 0, high = 0;
            for (const std::span<const Point> side : {edges, corners})
                for (const Point& p : side) {
                    const double h = dot(normal, p - a);
                    low = std::min(low, h), high = std::max(high, h);
                }
            if (low < -slack && high > slack) continue;
            if (low >= -slack && high <= slack) continue;  // both in one plane
            const double sign = low < -slack ? -1 : 1;
            planes_.push_back({sign * normal, sign * dot(normal, a)});
            break;
        }
    }
}

bool Shaft::reaches_in(PieceId p) {
    const ConvexPiece& piece = occluders_->pieces()[p];
    if (piece.region == receiver_region_ || piece.region == source_region_) return false;
    const std::span<const Point> corners = occluders_->corners(p);
    if (highest(corners, source_plane_) <= piece.thickness) return false;
    bool crosses = false;
    for (const Plane& plane : planes_) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (const Point& c : corners) {
            const double h = plane.signed_distance(c);
            low = std::min(low, h), high = std::max(high, h);
        }
        if (high <= 0) return false;
        crosses |= low < 0;
    }
    if (!crosses) return true;
    part_.assign(corners.begin(), corners.end());
    for (const Plane& plane : planes_) {
        clip_by(plane, part_);
        if (part_.empty()) return false;
    }
    return true;
}

bool Shaft::blocks_all(PieceId p) {
    const ConvexPiece& piece = occluders_->pieces()[p];
    if (occluders_->pieces(piece.region).size() > 1) {
        if (std::find(in_vain_.begin(), in_vain_.end(), piece.region) != in_vain_.end()) return false;
        if (blocks_all(piece.region)) return true;
        in_vain_.push_back(piece.region);
        return false;
    }
    const std::span<const Point> corners = occluders_->corners(p);
    const double slack = occluders_->rounding();
    const double side = piece.plane.signed_distance(mean(receiver_)) > 0 ? 1 : -1;
    const auto beyond = [&](const Point& x, const Point& y, double margin) {  // does O hold the crossing of x y?
        const double hx = side * piece.plane.signed_distance(x), hy = side * piece.plane.signed_distance(y);
        if (hx < 0 || hy > 0 || hx - hy <= slack) return false;
        const Point at = x + (hx / (hx - hy)) * (y - x);
        for (std::size_t i = 0, m = corners.size(); i < m; ++i) {
            const Vec3 edge = corners[i + 1 == m ? 0 : i + 1] - corners[i];
            if (dot(cross(piece.plane.n, edge), at - corners[i]) < margin * norm(edge)) return false;
        }
        return true;
    };
    // The middles well inside, so that closed containment of the corners' segments leaves only slivers open.
    if (!beyond(mean(receiver_), mean(source_), 100 * slack)) return false;
    for (const Point& x : receiver_)
        for (const Point& y : source_)
            if (!beyond(x, y, -slack)) return false;
    return true;
}

bool Shaft::blocks_all(RegionId r) {
    const Region& region = occluders_->scene().regions()[r];
    const double slack = occluders_->rounding();
    const double side = region.plane.signed_distance(mean(receiver_)) > 0 ? 1 : -1;
    const Frame frame(region.plane.n);
    const Point origin = region.loops[0][0];
    const auto flat = [&](const Point& p) { return Vec2{dot(frame.u, p - origin), dot(frame.v, p - origin)}; };
    crossings_.clear();
    for (const Point& x : receiver_)
        for (const Point& y : source_) {
            const double hx = side * region.plane.signed_distance(x), hy = side * region.plane.signed_distance(y);
            if (hx < 0 || hy > 0 || hx - hy <= slack) return false;
            crossings_.push_back(flat(x + (hx / (hx - hy)) * (y - x)));
        }
    make_hull(crossings_, hull_);
    if (hull_.size() < 3) return false;
    Vec2 middle;
    for (const Vec2& p : hull_) middle = middle + (1.0 / static_cast<double>(hull_.size())) * p;
    bool holds_middle = false;
    for (const std::vector<Point>& loop : region.loops) {
        Vec2 a = flat(loop.back());
        for (const Point& p : loop) {
            const Vec2 b = flat(p);
            if (enters(a, b, hull_, slack)) return false;
            if ((a.y > middle.y) != (b.y > middle.y) && middle.x - a.x < (b.x - a.x) * ((middle.y - a.y) / (b.y - a.y)))
                holds_middle = !holds_middle;
            a = b;
        }
    }
    return holds_middle;
}

View Shaft::classify(std::vector<PieceId>& candidates) {
    candidates.clear();
    in_vain_.clear();
    if (receiver_.empty() || source_.empty()) return View::none;
    const auto look = [&](PieceId p) {
        if (!reaches_in(p)) return false;
        candidates.push_back(p);
        return blocks_all(p);
    };
    const bool blocked = occluders_->visit_region(Occluders::Size::large, region_, look) ||
                         occluders_->visit_region(Occluders::Size::small, region_, look);
    if (blocked) blocker_ = candidates.back();
    if (blocked) candidates.clear();
    return blocked ? View::none : candidates.empty() ? View::open : View::mixed;
}

bool Shaft::is_blocked_by(PieceId p) {
    in_vain_.clear();
    return !receiver_.empty() && !source_.empty() && reaches_in(p) && blocks_all(p);
}

View Shaft::classify(std::span<const PieceId> from, std::vector<PieceId>& candidates) {
    candidates.clear();
    in_vain_.clear();
    if (receiver_.empty() || source_.empty()) return View::none;
    for (PieceId p : from) {
        if (!reaches_in(p)) continue;
        candidates.push_back(p);
        if (!blocks_all(p)) continue;
        blocker_ = p;
        candidates.clear();
        return View::none;
    }
    return candidates.empty() ? View::open : View::mixed;
}

}  // namespace exitance
