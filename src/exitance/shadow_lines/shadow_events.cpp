#include "exitance/shadow_lines/shadow_events.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

constexpr double coplanar_sine = 1e-7;  // below this, an edge counts as parallel to a wedge's plane

/// Computes the ends of the segment in which a convex polygon crosses a plane. Returns false if it misses or only
/// touches the plane.
bool crossing(std::span<const Point> corners, const Point& on, const Vec3& normal, double slack, Point& from,
              Point& to) {
    double highest = -HUGE_VAL, lowest = HUGE_VAL;
    for (const Point& p : corners) {
        const double d = dot(normal, p - on);
        highest = std::max(highest, d), lowest = std::min(lowest, d);
    }
    if (highest <= slack || lowest >= -slack) return false;
    int found = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point &p = corners[i], &q = corners[(i + 1) % corners.size()];
        const double dp = dot(normal, p - on), dq = dot(normal, q - on);
        if ((dp > 0) == (dq > 0)) continue;
        (found++ == 0 ? from : to) = p + (dp / (dp - dq)) * (q - p);
    }
    return found >= 2;
}

/// Reduces the segment to where a function that is linear along it exceeds `least`. Returns false if nothing is left.
bool cut(Point& a, Point& b, double at_a, double at_b, double least) {
    if (at_a <= least && at_b <= least) return false;
    if (at_a < least) a = a + ((least - at_a) / (at_b - at_a)) * (b - a);
    if (at_b < least) b = b + ((least - at_b) / (at_a - at_b)) * (a - b);
    return true;
}

}  // namespace

/// Reduces [first, last] to where at_zero + t rate >= 0. Returns false if nothing is left.
bool ShadowEventFinder::limit(double at_zero, double rate, double& first, double& last) const {
    if (rate == 0) return at_zero >= 0;
    const double t = -at_zero / rate;
    if (rate > 0)
        first = std::max(first, t);
    else
        last = std::min(last, t);
    return first < last;
}

/// Point in the receiver's plane that the sight line of parameter t reaches.
Vec2 ShadowEventFinder::shadow(const Wedge& wedge, double t) const {
    const Point through = wedge.base + t * wedge.along;
    const double ha = frame_->height(wedge.apex), hb = frame_->height(through);
    const Vec2 a = frame_->flat(wedge.apex), b = frame_->flat(through);
    return a + (ha / (ha - hb)) * (b - a);
}

/// Restricts the wedge to sight lines that reach the box on the receiver. The wedge's line on the receiver is a
/// projective function of t, so each side of the box is a linear condition on t, and so is reaching the plane at all.
bool ShadowEventFinder::clip_to_box(Wedge& wedge, double height) const {
    const Vec2 a = frame_->flat(wedge.apex), b = frame_->flat(wedge.base);
    const Vec2 d = {dot(frame_->u, wedge.along), dot(frame_->v, wedge.along)};
    const double hb = frame_->height(wedge.base), dh = dot(frame_->n, wedge.along);
    // shadow(t) = (ha (b + t d) - (hb + t dh) a) / (ha - hb - t dh); beyond the apex the denominator is negative.
    const double sign = wedge.beyond ? -1 : 1, margin = 1e-9 * std::max(height, std::abs(hb) + std::abs(dh));
    if (!limit(sign * (height - hb) - margin, -sign * dh, wedge.first, wedge.last)) return false;
    const auto side = [&](double at_a, double at_b, double rate, double bound, double way) {
        const double zero = way * (height * at_b - hb * at_a - bound * (height - hb));
        const double slope = way * (height * rate - dh * at_a + bound * dh);
        return limit(sign * zero, sign * slope, wedge.first, wedge.last);
    };
    return side(a.x, b.x, d.x, lo_.x, 1) && side(a.x, b.x, d.x, hi_.x, -1) && side(a.y, b.y, d.y, lo_.y, 1) &&
           side(a.y, b.y, d.y, hi_.y, -1);
}

/// Appends to hidden_ the parameter intervals of the sight lines that a piece blocks. Returns whether it blocks all of
/// them.
bool ShadowEventFinder::blank(const Wedge& wedge, const Vec3& normal, PieceId number) {
    const ConvexPiece& piece = occluders_->pieces()[number];
    if (occluders_->is_own(piece.region, own_) || piece.region == source_->region) return false;
    const double tolerance = edges_->tolerance();
    const bool holds_apex = std::abs(piece.plane.signed_distance(wedge.apex)) <= tolerance;
    const bool holds_base = std::abs(piece.plane.signed_distance(wedge.base)) <= tolerance &&
                            std::abs(piece.plane.signed_distance(wedge.base + wedge.along)) <= tolerance;
    if (holds_base || (holds_apex && (wedge.beyond || wedge.passes_apex)))
        return false;  // it touches the sight lines only in their own corner or edge
    Point c, d;
    if (!crossing(occluders_->corners(number), wedge.apex, normal, tolerance, c, d)) return false;
    if (!cut(c, d, frame_->height(c), frame_->height(d), min_)) return false;
    if (!source_->is_point && !cut(c, d, source_->plane.signed_distance(c), source_->plane.signed_distance(d), min_))
        return false;
    // p = apex + m (base - apex + t along), by two equations in the wedge's plane
    const Vec3 b = wedge.base - wedge.apex;
    const double area = dot(cross(b, wedge.along), normal);
    const auto m_of = [&](const Point& p) { return dot(cross(p - wedge.apex, wedge.along), normal) / area; };
    const auto mt_of = [&](const Point& p) { return dot(cross(b, p - wedge.apex), normal) / area; };
    bool all = false;
    const auto add = [&](Point from, Point to, double sign) {
        constexpr double min_m = 1e-9;
        if (!cut(from, to, sign * m_of(from), sign * m_of(to), min_m)) return;
        const double s = mt_of(from) / m_of(from), t = mt_of(to) / m_of(to);
        hidden_.emplace_back(std::min(s, t), std::max(s, t));
        all |= hidden_.back().first <= wedge.first && hidden_.back().second >= wedge.last;
    };
    add(c, d, 1);
    if (wedge.beyond || wedge.passes_apex) add(c, d, -1);
    return all;
}

/// The part of a wedge's plane (as thick as the tolerance) between its outermost sight lines, in front of the receiver
/// and the source. side: 1 on the base's side of the apex, -1 on the other.
ConvexRegion ShadowEventFinder::fan(const Wedge& wedge, const Vec3& normal, double side) const {
    const Point p = wedge.base + wedge.first * wedge.along, q = wedge.base + wedge.last * wedge.along;
    const double slack = edges_->tolerance(), at = dot(normal, wedge.apex);
    ConvexRegion out;
    out.add({normal, at - slack}), out.add({-normal, -at - slack});
    for (const auto& [from, other] : {std::pair{p, q}, std::pair{q, p}}) {
        Vec3 inside = cross(normal, from - wedge.apex);
        if (side * dot(inside, other - wedge.apex) < 0) inside = -inside;
        out.add({inside, dot(inside, wedge.apex) - slack * norm(inside)});
    }
    out.add({frame_->n, dot(frame_->n, frame_->origin)});
    if (!source_->is_point) out.add(source_->plane);
    return out;
}

void ShadowEventFinder::keep_visible(const Wedge& wedge, ShadowEvent event, std::vector<ShadowEvent>& events) {
    ++wedges;
    const Point p = wedge.base + wedge.first * wedge.along, q = wedge.base + wedge.last * wedge.along;
    const Vec3 across = cross(p - wedge.apex, q - wedge.apex);
    const double area = norm(across);
    if (!(area > 0)) return;
    const Vec3 normal = across / area;
    hidden_.clear();
    bool all = false;
    const auto visit = [&](PieceId piece) { return all = blank(wedge, normal, piece); };
    // Sight lines that continue past the apex have a fan on each side of it.
    const bool both = wedge.beyond || wedge.passes_apex;
    for (const std::span<const PieceId>& list : lists_)
        for (std::size_t i = 0; i < list.size() && !all; ++i) ++plane_tests, visit(list[i]);
    for (const double side : {1.0, -1.0}) {
        if (bounds_.lists || (side < 0 && !both)) break;
        const ConvexRegion region = fan(wedge, normal, side);
        for (const Occluders::Size size : {Occluders::Size::large, Occluders::Size::small})
            if (!all) occluders_->visit_inner(size, region, visit, {});
    }
    if (all) return;
    std::sort(hidden_.begin(), hidden_.end());
    constexpr double shortest = 1e-9;
    double from = wedge.first;
    const auto keep = [&](double to) {
        if (to <= from + shortest) return;
        event.a = shadow(wedge, from), event.b = shadow(wedge, to);
        if (!std::isfinite(event.a.x + event.a.y + event.b.x + event.b.y)) return;
        if (is_long_enough(event))
            events.push_back(event);
        else
            ++too_weak;
    };
    for (const auto& [a, b] : hidden_) {
        keep(std::min(a, wedge.last));
        from = std::max(from, b);
        if (from >= wedge.last) return;
    }
    keep(wedge.last);
}

void ShadowEventFinder::add_corner_over_edge(const Point& s, const Vec3& before, const Vec3& after,
                                             const BlockerEdges::Edge& edge, double gain,
                                             std::vector<ShadowEvent>& events) {
    const double height = frame_->height(s);
    if (height <= min_ || !edges_->is_outline(edge, s)) return;
    Wedge wedge{s, edge.a, edge.b - edge.a};
    const double ha = frame_->height(edge.a), hb = frame_->height(edge.b);
    if (!limit(ha - (ha > min_ && hb > min_ ? 0 : min_), hb - ha, wedge.first, wedge.last)) return;
    if (!source_->is_point) {
        const double da = source_->plane.signed_distance(edge.a), db = source_->plane.signed_distance(edge.b);
        if (!limit(da - min_, db - da, wedge.first, wedge.last)) return;
    }
    if (!clip_to_box(wedge, height)) return;
    const Vec3 plane = cross(edge.a - s, edge.b - s);
    const double size = norm(plane);
    if (!(size > 0)) return;
    ShadowEvent event;
    event.gain = gain;
    for (const Vec3& f : {before, after}) event.is_kink |= std::abs(dot(plane, f)) <= coplanar_sine * size * norm(f);
    if (!counts(event)) return;
    const double t = 0.5 * (wedge.first + wedge.last), h = frame_->height(edge.a + t * (edge.b - edge.a));
    event.width = source_->size * std::max(h, 0.0) / std::max(height - h, 1e-9 * height);
    keep_visible(wedge, event, events);
}

void ShadowEventFinder::add_edge_over_corner(const Point& q0, const Point& q1, std::size_t index,
                                             std::vector<ShadowEvent>& events) {
    const std::uint32_t corner = corners_[index].first;
    const Point w = corners_[index].second;
    const double height = frame_->height(w);
    if (height <= min_ || source_->plane.signed_distance(w) <= min_) return;
    const Vec3 plane = cross(q0 - w, q1 - w);
    const double size = norm(plane);
    if (!(size > 0)) return;
    bool outline = false;
    ShadowEvent event;
    event.by_edge_of_source = true, event.gain = corner_gains_[index];
    auto at = std::lower_bound(edges_at_.begin(), edges_at_.end(), std::pair{corner, 0u});
    for (; at != edges_at_.end() && at->first == corner; ++at) {
        const BlockerEdges::Edge& edge = edges_->edges()[at->second];
        if (!edges_->is_outline(edge, q0) && !edges_->is_outline(edge, q1)) continue;
        outline = true;
        const Vec3 d = edge.b - edge.a;
        event.is_kink |= std::abs(dot(plane, d)) <= coplanar_sine * size * norm(d);
    }
    if (!outline || !counts(event)) return;
    Wedge wedge{w, q0, q1 - q0, 0, 1, true};
    if (!clip_to_box(wedge, height)) return;
    const double t = 0.5 * (wedge.first + wedge.last), h = frame_->height(q0 + t * (q1 - q0));
    event.width = source_->size * height / std::max(h - height, 1e-9 * h);
    keep_visible(wedge, event, events);
}

void ShadowEventFinder::set(const PlaneFrame& receiver, RegionId own, Vec2 lo, Vec2 hi, const EventSource& source,
                            std::span<const std::uint32_t> among) {
    frame_ = &receiver, source_ = &source, own_ = own, lo_ = lo, hi_ = hi;
    min_ = 4 * edges_->tolerance();
    corners_.clear(), edges_at_.clear();
    for (const std::uint32_t e : among) {
        const BlockerEdges::Edge& edge = edges_->edges()[e];
        corners_.emplace_back(edge.ends[0], edge.a), corners_.emplace_back(edge.ends[1], edge.b);
        edges_at_.emplace_back(edge.ends[0], e), edges_at_.emplace_back(edge.ends[1], e);
    }
    const auto less = [](const auto& x, const auto& y) { return x.first < y.first; };
    std::stable_sort(corners_.begin(), corners_.end(), less);
    corners_.erase(
        std::unique(corners_.begin(), corners_.end(), [](const auto& x, const auto& y) { return x.first == y.first; }),
        corners_.end());
    std::sort(edges_at_.begin(), edges_at_.end());
    corner_gains_.assign(corners_.size(), bounds_.gains.empty() ? HUGE_VAL : 0);
    for (std::size_t i = 0; i < bounds_.gains.size() && i < among.size(); ++i)
        for (const std::uint32_t end : edges_->edges()[among[i]].ends) {
            const auto at = std::lower_bound(corners_.begin(), corners_.end(), end,
                                             [](const auto& corner, std::uint32_t n) { return corner.first < n; });
            double& gain = corner_gains_[static_cast<std::size_t>(at - corners_.begin())];
            gain = std::max(gain, bounds_.gains[i]);
        }
}

void ShadowEventFinder::find(const PlaneFrame& receiver, RegionId own, Vec2 lo, Vec2 hi, const EventSource& source,
                             std::span<const std::uint32_t> among, std::vector<ShadowEvent>& events) {
    set(receiver, own, lo, hi, source, among);
    std::size_t first = 0;  // index of the loop's first corner
    const auto list = [&](std::size_t corner) {
        return bounds_.lists ? std::span<const PieceId>(bounds_.lists->of_corner[corner]) : std::span<const PieceId>();
    };
    for (const auto& loop : source.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            lists_ = {list(first + i), {}};
            const Point &s = loop[i], &next = loop[(i + 1) % loop.size()];
            const Point& previous = loop[(i + loop.size() - 1) % loop.size()];
            for (std::size_t e = 0; e < among.size() && !is_stopped(); ++e)
                add_corner_over_edge(s, previous - s, next - s, edges_->edges()[among[e]],
                                     bounds_.gains.empty() ? HUGE_VAL : bounds_.gains[e], events);
            if (source.is_point) continue;
            lists_[1] = list(first + (i + 1) % loop.size());
            for (std::size_t c = 0; c < corners_.size() && !is_stopped(); ++c) add_edge_over_corner(s, next, c, events);
        }
        first += loop.size();
    }
}

}  // namespace exitance
