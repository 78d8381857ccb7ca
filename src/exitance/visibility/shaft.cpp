#include "exitance/visibility/shaft.hpp"

#include <algorithm>
#include <limits>

#include "exitance/base/limits.hpp"

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

/// The corners of a facet. If several surfaces share a plane, those of an upper one are raised (Occluders::lift): as
/// seen from the plane itself, the covered surfaces would hide everything.
void take(const Occluders& occluders, const Facet& facet, std::vector<Point>& corners) {
    corners.assign(facet.corners.begin(), facet.corners.end());
    const double lift = facet.region.is_none() ? 0 : occluders.lift(facet.region);
    if (!(lift > 0)) return;
    const Plane& plane = occluders.scene().regions()[facet.region].plane;
    for (Point& p : corners) p = p - (plane.signed_distance(p) - lift) * plane.n;
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
    take(occluders, receiver, receiver_), take(occluders, source, source_);
    receiver_plane_ = {receiver.n, dot(receiver.n, receiver_[0])};
    source_plane_ = {source.n, dot(source.n, source_[0])};
    constexpr double noise = 64 * std::numeric_limits<double>::epsilon();
    slack_ = occluders.rounding();
    if (source.is_distant) slack_ = std::max(slack_, noise * norm(source.corners[0] - receiver.corners[0]));
    const double slack = slack_;
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
        plane.offset += slack;  // occluders that only touch the shaft are outside
        region_.add(plane);
    }
}

void Shaft::add_supporting_planes(std::span<const Point> edges, std::span<const Point> corners) {
    const double slack = slack_;
    for (std::size_t i = 0, m = edges.size(); i < m; ++i) {
        const Point &a = edges[i], &b = edges[i + 1 == m ? 0 : i + 1];
        for (const Point& c : corners) {
            Vec3 normal = cross(b - a, c - a);
            const double length = norm(normal);
            if (length <= zero_sine * norm(b - a) * norm(c - a) || length == 0)
                continue;  // c is collinear with the edge
            normal *= 1 / length;
            double low = 0, high = 0;
            for (const std::span<const Point> side : {edges, corners})
                for (const Point& p : side) {
                    const double h = dot(normal, p - a);
                    low = std::min(low, h), high = std::max(high, h);
                }
            if (low < -slack && high > slack) continue;
            if (low >= -slack && high <= slack) continue;  // both polygons lie in one plane
            // A corner in the plane of the edge's polygon, e.g. where the two polygons share an edge, would only give
            // that plane again.
            if (std::all_of(edges.begin(), edges.end(),
                            [&](const Point& p) { return std::abs(dot(normal, p - a)) <= slack; }))
                continue;
            const double sign = low < -slack ? -1 : 1;
            planes_.push_back({sign * normal, sign * dot(normal, a)});
            break;
        }
    }
}

bool Shaft::reaches_in(PieceId p) {
    const ConvexPiece& piece = occluders_->pieces()[p];
    if (occluders_->is_own(piece.region, receiver_region_) || piece.region == source_region_) return false;
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
        if (std::find(not_covering_.begin(), not_covering_.end(), piece.region) != not_covering_.end()) return false;
        if (blocks_all(piece.region)) return true;
        not_covering_.push_back(piece.region);
        return false;
    }
    const std::span<const Point> corners = occluders_->corners(p);
    const double slack = slack_;
    const double side = piece.plane.signed_distance(mean(receiver_)) > 0 ? 1 : -1;
    const auto beyond = [&](const Point& x, const Point& y,
                            double margin) {  // true if the line x y crosses the plane within the piece or its margin
        const double hx = side * piece.plane.signed_distance(x), hy = side * piece.plane.signed_distance(y);
        if (hx < 0 || hy > 0 || hx - hy <= slack) return false;
        const Point at = x + (hx / (hx - hy)) * (y - x);
        for (std::size_t i = 0, m = corners.size(); i < m; ++i) {
            const Vec3 edge = corners[i + 1 == m ? 0 : i + 1] - corners[i];
            if (dot(cross(piece.plane.n, edge), at - corners[i]) < margin * norm(edge)) return false;
        }
        return true;
    };
    // The segment between the middles must cross well inside: then only slivers can remain unblocked when the corners'
    // segments cross within the closed piece.
    if (!beyond(mean(receiver_), mean(source_), 100 * slack)) return false;
    for (const Point& x : receiver_)
        for (const Point& y : source_)
            if (!beyond(x, y, -slack)) return false;
    return true;
}

bool Shaft::blocks_all(RegionId r) {
    cover_.begin(occluders_->scene().regions()[r], slack_);
    for (const Point& x : receiver_)
        for (const Point& y : source_)
            if (!cover_.add(x, y)) return false;
    return cover_.covers();
}

View Shaft::classify(std::vector<PieceId>& candidates, std::size_t most) {
    candidates.clear();
    not_covering_.clear();
    if (receiver_.empty() || source_.empty()) return View::none;
    if (are_in_scene() && occluders_->has_nothing_inside()) return View::open;
    bool blocked = false;
    const auto look = [&](PieceId p) {
        if (!reaches_in(p)) return false;
        candidates.push_back(p);
        blocked = blocks_all(p);
        return blocked || candidates.size() > most;
    };
    const Vec3 direction = source_[0] - receiver_[0];  // front to back from the receiver: near walls block most often
    const bool in_scene = are_in_scene();
    bool ended = false;
    for (const Occluders::Size size : {Occluders::Size::large, Occluders::Size::small})
        ended = ended || (in_scene ? occluders_->visit_inner(size, region_, look, direction)
                                   : occluders_->visit_region(size, region_, look, direction));
    if (blocked) blocker_ = candidates.back();
    if (blocked) candidates.clear();
    return blocked ? View::none : candidates.empty() ? View::open : View::mixed;
}

bool Shaft::is_blocked_by(PieceId p) {
    not_covering_.clear();
    return !receiver_.empty() && !source_.empty() && reaches_in(p) && blocks_all(p);
}

View Shaft::classify(std::span<const PieceId> from, std::vector<PieceId>& candidates) {
    candidates.clear();
    not_covering_.clear();
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
