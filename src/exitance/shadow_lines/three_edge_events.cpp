#include "exitance/shadow_lines/three_edge_events.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

/// The function a + b s.
struct Linear {
    double a = 0, b = 0;
    double operator()(double s) const { return a + b * s; }
};

/// Numerator and denominator of the position on `far` (0 to 1 along the edge) at which the plane through q0 + s (q1 -
/// q0) and `near` meets it.
struct Ratio {
    Linear up, down;

    Ratio(const Point& q0, const Point& q1, const BlockerEdges::Edge& near, const BlockerEdges::Edge& far) {
        const Vec3 along = near.b - near.a;
        // (a - q) x (b - q) = (a - q) x (b - a), linear in q
        const Vec3 n0 = cross(near.a - q0, along), n1 = -cross(q1 - q0, along);
        const Vec3 gap = near.a - far.a, d = far.b - far.a;
        up = {dot(n0, gap), dot(n1, gap)}, down = {dot(n0, d), dot(n1, d)};
    }
    double at(double s) const { return up(s) / down(s); }
};

/// Reduces [first, last] to where f(s) >= 0. Returns false if nothing is left.
bool limit(const Linear& f, double& first, double& last) {
    if (f.b == 0) return f.a >= 0 && first < last;
    const double s = -f.a / f.b;
    if (f.b > 0)
        first = std::max(first, s);
    else
        last = std::min(last, s);
    return first < last;
}

/// Parts of [first, last] in which the ratio is between 0 and 1: at most two, one for each sign of the denominator,
/// since the ratio is infinite where the denominator changes sign.
std::vector<std::pair<double, double>> within(const Ratio& r, double first, double last) {
    std::vector<std::pair<double, double>> out;
    for (const double sign : {1.0, -1.0}) {
        double a = first, b = last;
        const Linear up{sign * r.up.a, sign * r.up.b}, down{sign * r.down.a, sign * r.down.b};
        if (limit(down, a, b) && limit(up, a, b) && limit({down.a - up.a, down.b - up.b}, a, b)) out.emplace_back(a, b);
    }
    return out;
}

Vec3 line_along(const BlockerEdges::Edge& e) {
    return e.b - e.a;
}

}  // namespace

ThreeEdgeEventFinder::Sight ThreeEdgeEventFinder::sight(double s, const Point& q0, const Point& q1,
                                                        const BlockerEdges::Edge& e,
                                                        const BlockerEdges::Edge& f) const {
    Sight out;
    out.q = q0 + s * (q1 - q0);
    out.p = e.a + Ratio(q0, q1, f, e).at(s) * line_along(e);
    out.r = f.a + Ratio(q0, q1, e, f).at(s) * line_along(f);
    // Both points are on one line with q; the farther one defines the line more accurately.
    const Point& through = squared_norm(out.p - out.q) > squared_norm(out.r - out.q) ? out.p : out.r;
    const double hq = frame_->height(out.q), ht = frame_->height(through);
    if (!(hq > ht + 1e-9 * std::abs(hq))) return out;
    const Point x = out.q + (hq / (hq - ht)) * (through - out.q);
    out.place = frame_->flat(x);
    const double hp = frame_->height(out.p), hr = frame_->height(out.r);
    out.is_free = std::isfinite(out.place.x + out.place.y) && hp > min_ && hr > min_ && hp < hq && hr < hq &&
                  source_->plane.signed_distance(out.p) > min_ && source_->plane.signed_distance(out.r) > min_ &&
                  out.place.x >= lo_.x && out.place.x <= hi_.x && out.place.y >= lo_.y && out.place.y <= hi_.y &&
                  edges_->is_outline(e, out.q) && edges_->is_outline(f, out.q) && !is_hidden(out, x);
    return out;
}

/// Returns whether the interior of a piece blocks the line of sight. Pieces that it only grazes belong to the edges
/// themselves.
bool ThreeEdgeEventFinder::is_hidden(const Sight& sight, const Point& end) const {
    const Vec3 d = end - sight.q;
    const double slack = 8 * edges_->tolerance();
    const auto stands = [&](PieceId number) {
        const ConvexPiece& piece = occluders_->pieces()[number];
        if (occluders_->is_own(piece.region, own_) || piece.region == source_->region) return false;
        const double from = piece.plane.signed_distance(sight.q), to = piece.plane.signed_distance(end);
        if ((from > slack) != (to < -slack) || std::abs(from - to) <= 2 * slack) return false;
        const Point at = sight.q + (from / (from - to)) * d;
        const auto corners = occluders_->corners(number);
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Vec3 border = corners[(i + 1) % corners.size()] - corners[i];
            const Vec3 inside = cross(piece.plane.n, border);
            if (dot(inside, at - corners[i]) <= slack * norm(inside)) return false;
        }
        return true;
    };
    bool hidden = false;
    for (const Occluders::Size size : {Occluders::Size::large, Occluders::Size::small})
        if (!hidden) occluders_->visit_segment(size, sight.q, d, [&](PieceId p) { return hidden |= stands(p); });
    return hidden;
}

/// Returns whether the event may bound an umbra. Seen along the line of sight, the three edges are lines through one
/// point, each with a side on which the source is not cut off. Suppose these three half-planes have only that point in
/// common. Then a step to one side of the conic leaves a small triangle of the source visible, and a step to the other
/// side nothing.
bool ThreeEdgeEventFinder::bounds_umbra(const Sight& sight, const Point& q0, const Point& q1,
                                        const BlockerEdges::Edge& e, const BlockerEdges::Edge& f) const {
    const Vec3 view = sight.r - sight.q + (sight.p - sight.q);
    const Frame frame{Normal(normalized(view))};
    const auto flat = [&](const Vec3& v) { return Vec2{dot(frame.u, v), dot(frame.v, v)}; };
    std::array<Vec2, 3> sides;
    // Loops are counter-clockwise about the front, so the inside is to the left.
    sides[0] = flat(cross(source_->plane.n, q1 - q0));
    const std::array<const BlockerEdges::Edge*, 2> edges{&e, &f};
    for (std::size_t i = 0; i < 2; ++i) {
        const int free = edges_->free_side(*edges[i], sight.q);
        if (free == 0) return false;
        sides[i + 1] = flat(static_cast<double>(free) * cross(edges[i]->a - sight.q, edges[i]->b - sight.q));
    }
    for (Vec2& v : sides) {
        const double l = std::hypot(v.x, v.y);
        if (!(l > 0)) return false;
        v = (1 / l) * v;
    }
    // True if the normals surround the point: each pair of consecutive ones turns in the same direction.
    const double a = cross(sides[0], sides[1]), b = cross(sides[1], sides[2]), c = cross(sides[2], sides[0]);
    return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
}

void ThreeEdgeEventFinder::follow(const Point& q0, const Point& q1, const BlockerEdges::Edge& e,
                                  const BlockerEdges::Edge& f, Interval part,
                                  std::vector<ThreeEdgeEvent>& events) const {
    constexpr std::size_t samples = 16;  // number of points along the part at which occlusion is tested
    std::vector<Sight> sights;
    for (std::size_t i = 0; i <= samples; ++i) {
        // At the ends the lines of sight pass through corners, which rounding may put on either side.
        const double at = std::clamp(static_cast<double>(i) / samples, 1e-6, 1 - 1e-6);
        sights.push_back(sight(part.first + at * (part.last - part.first), q0, q1, e, f));
    }
    const auto cut = [&](double from,  // a visible parameter
                         double to) {  // a hidden parameter; bisection returns the last visible one
        constexpr int halvings = 30;
        for (int i = 0; i < halvings; ++i) {
            const double middle = 0.5 * (from + to);
            (sight(middle, q0, q1, e, f).is_free ? from : to) = middle;
        }
        return from;
    };
    const auto parameter = [&](std::size_t i) {
        return part.first + static_cast<double>(i) / samples * (part.last - part.first);
    };
    for (std::size_t i = 0; i <= samples; ++i) {
        if (!sights[i].is_free) continue;
        std::size_t end = i;
        while (end < samples && sights[end + 1].is_free) ++end;
        const double from = i > 0 ? cut(parameter(i), parameter(i - 1)) : part.first;
        const double to = end < samples ? cut(parameter(end), parameter(end + 1)) : part.last;
        ThreeEdgeEvent event;
        event.may_bound_umbra = bounds_umbra(sights[(i + end) / 2], q0, q1, e, f);
        i = end;
        if (umbra_only_ && !event.may_bound_umbra) continue;
        const auto place = [&](double s) { return sight(s, q0, q1, e, f).place; };
        const Vec2 a = place(from), b = place(to), m = place(0.5 * (from + to));
        const Vec2 chord = b - a;
        const double length = std::hypot(chord.x, chord.y);
        if (!(length > 4 * sagitta_)) continue;
        // The distance to the conic is quadratic in the chord's parameter range.
        const double off = std::abs(cross(chord, m - a)) / length;
        constexpr double max_chords = 32;
        const auto count = static_cast<int>(std::clamp(std::ceil(std::sqrt(off / sagitta_)), 1.0, max_chords));
        event.places.push_back(a);
        for (int k = 1; k < count; ++k) event.places.push_back(place(from + k * (to - from) / count));
        event.places.push_back(b);
        events.push_back(std::move(event));
    }
}

void ThreeEdgeEventFinder::find(const EventReceiver& receiver, const EventSource& source,
                                std::span<const std::uint32_t> among, bool umbra_only, double sagitta,
                                std::vector<ThreeEdgeEvent>& events) {
    frame_ = &receiver.frame, source_ = &source, own_ = receiver.region, lo_ = receiver.lo, hi_ = receiver.hi;
    umbra_only_ = umbra_only, sagitta_ = sagitta, min_ = 4 * edges_->tolerance();
    if (source.is_point) return;
    for (const auto& loop : source.loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Point &q0 = loop[i], &q1 = loop[(i + 1) % loop.size()];
            std::vector<std::uint32_t> outlines;
            for (const std::uint32_t e : among) {
                const BlockerEdges::Edge& edge = edges_->edges()[e];
                if (edges_->is_outline(edge, q0) || edges_->is_outline(edge, q1)) outlines.push_back(e);
            }
            for (std::size_t j = 0; j < outlines.size() && !(stop_ && stop_->requested()); ++j)
                for (std::size_t k = j + 1; k < outlines.size(); ++k) {
                    const BlockerEdges::Edge &e = edges_->edges()[outlines[j]], &f = edges_->edges()[outlines[k]];
                    const bool meet = e.ends[0] == f.ends[0] || e.ends[0] == f.ends[1] || e.ends[1] == f.ends[0] ||
                                      e.ends[1] == f.ends[1];
                    if (meet) continue;  // adjacent edges: the events of their common corner cover these
                    // Lines in one plane with the source's edge or with each other do not span a quadric.
                    constexpr double coplanar = 1e-9;
                    const Vec3 de = line_along(e), df = line_along(f), dq = q1 - q0;
                    const double skew = std::abs(dot(f.a - e.a, cross(de, df)));
                    if (skew <= coplanar * norm(de) * norm(df) * (norm(f.a - e.a) + norm(de))) continue;
                    if (norm(cross(dq, de)) == 0 && norm(cross(dq, df)) == 0) continue;
                    for (const auto& [a, b] : within(Ratio(q0, q1, e, f), 0, 1))
                        for (const auto& [c, d] : within(Ratio(q0, q1, f, e), a, b))
                            if (d - c > coplanar) follow(q0, q1, e, f, {c, d}, events);
                }
        }
}

}  // namespace exitance
