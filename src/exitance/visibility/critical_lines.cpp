#include "exitance/visibility/critical_lines.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exitance/base/limits.hpp"

namespace exitance {

void CriticalLineFinder::find_corners(const SeenEdges& blocker) {
    is_seen_.assign(blocker.body->points.size(), 0);
    corners_.clear();
    for (std::uint32_t k : blocker.edges)
        for (std::uint32_t c : {blocker.body->edges[k].a, blocker.body->edges[k].b})
            if (!std::exchange(is_seen_[c], 1)) corners_.push_back(c);
}

/// Adds lines on which a corner of one blocker appears on an edge of another, in front of the source: the gap between
/// the two closes there.
void CriticalLineFinder::add_gaps(const PlaneFrame& frame, std::span<const Point> source, const SeenEdges& far,
                                  const SeenEdges& near, std::vector<CriticalLine>& lines) {
    find_corners(far);
    const ConvexBlocker& body = *near.body;
    for (std::uint32_t c : corners_) {
        const Point& w = far.body->points[c];
        const Vec2 from = frame.flat(w);
        const double high = frame.height(w);
        if (high <= nearness_) continue;
        for (std::uint32_t k : near.edges) {
            const ConvexBlocker::Edge& e = body.edges[k];
            const Point &a = body.points[e.a], &b = body.points[e.b];
            const auto faces_w = [&](std::int32_t f) {
                return body.faces[static_cast<std::size_t>(f)].signed_distance(w) > 0;
            };
            if (e.right != ConvexBlocker::no_face && faces_w(e.left) == faces_w(e.right)) continue;
            const double low_a = std::max(0.0, frame.height(a)), low_b = std::max(0.0, frame.height(b));
            if (low_a >= high && low_b >= high) continue;
            const Vec3 plane = cross(a - w, b - w);
            bool over = false, under = false;
            for (const Point& s : source) {
                const double d = dot(plane, s - w);
                over |= d > 0, under |= d < 0;
            }
            if (!over || !under) continue;  // this line of sight misses the source
            const Vec2 p = frame.flat(a), q = frame.flat(b);
            add({p.x * high - from.x * low_a, p.y * high - from.y * low_a, high - low_a},
                {q.x * high - from.x * low_b, q.y * high - from.y * low_b, high - low_b}, lines);
        }
    }
}

/// Adds lines from which a face is seen edge-on, if its plane cuts the source: the silhouette changes from one edge to
/// another.
void CriticalLineFinder::add_faces(const PlaneFrame& frame, std::span<const Point> source, const SeenEdges& blocker,
                                   std::vector<CriticalLine>& lines) {
    is_seen_.assign(blocker.body->faces.size(), 0);
    for (std::uint32_t k : blocker.edges)
        for (std::int32_t f : {blocker.body->edges[k].left, blocker.body->edges[k].right})
            if (f != ConvexBlocker::no_face) is_seen_[static_cast<std::size_t>(f)] = 1;
    for (std::size_t k = 0; k < is_seen_.size(); ++k) {
        if (!is_seen_[k]) continue;
        const Plane& face = blocker.body->faces[k];
        bool over = false, under = false;
        for (const Point& s : source) {
            const double d = face.signed_distance(s);
            over |= d > nearness_, under |= d < -nearness_;
        }
        const double x = dot(face.n, frame.u), y = dot(face.n, frame.v), length = std::sqrt(x * x + y * y);
        if (!over || !under || length < zero_sine || lines.size() >= max_) continue;
        const CriticalLine line{
            {x / length, y / length}, -face.signed_distance(frame.origin) / length, -HUGE_VAL, HUGE_VAL};
        if (crosses_receiver(line)) keep(line, lines);
    }
}

bool CriticalLineFinder::crosses_receiver(const CriticalLine& line) const {
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (Vec2 p : receiver_) {
        const double d = line.signed_distance(p);
        lowest = std::min(lowest, d), highest = std::max(highest, d);
    }
    return lowest <= -nearness_ && highest >= nearness_;
}

/// Keeps the line through the projections of an edge's ends, if it crosses the receiver within that projection.
void CriticalLineFinder::add(const Shadow& a, const Shadow& b, std::vector<CriticalLine>& lines) const {
    if (lines.size() >= max_ || (a.weight <= 0 && b.weight <= 0)) return;
    // The line joins them in homogeneous coordinates, even if one is at infinity.
    const double x = a.y * b.weight - a.weight * b.y, y = a.weight * b.x - a.x * b.weight, z = a.x * b.y - a.y * b.x;
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (Vec2 p : receiver_) {
        const double d = x * p.x + y * p.y + z;
        lowest = std::min(lowest, d), highest = std::max(highest, d);
    }
    if (lowest >= 0 || highest <= 0) return;  // the line misses the polygon, as most do
    const double length = std::sqrt(x * x + y * y);
    if (!(length > 0)) return;
    CriticalLine line{{x / length, y / length}, -z / length, 0, 0};
    if (!crosses_receiver(line)) return;
    const auto place = [&](const Shadow& s, const Shadow& other) {
        if (s.weight > 0) return line.along({s.x / s.weight, s.y / s.weight});
        // The projection passes through infinity between the two ends. Its direction from the other end determines the
        // side.
        const double t = other.weight / (other.weight - s.weight);
        const double dx = other.x + t * (s.x - other.x), dy = other.y + t * (s.y - other.y);
        return line.along({dx, dy}) > 0 ? HUGE_VAL : -HUGE_VAL;
    };
    const double from = place(a, b), to = place(b, a);
    line.first = std::min(from, to), line.last = std::max(from, to);
    keep(line, lines);
}

/// Adds a line unless it misses the receiver or equals a known one, which is then extended.
void CriticalLineFinder::keep(CriticalLine line, std::vector<CriticalLine>& lines) const {
    // Find the stretch of the line inside the receiver.
    double enters = HUGE_VAL, leaves = -HUGE_VAL;
    for (std::size_t i = 0; i < receiver_.size(); ++i) {
        const Vec2 p = receiver_[i], q = receiver_[i + 1 == receiver_.size() ? 0 : i + 1];
        const double dp = line.signed_distance(p), dq = line.signed_distance(q);
        if ((dp > 0) == (dq > 0)) continue;
        const double s = line.along(p + (dp / (dp - dq)) * (q - p));
        enters = std::min(enters, s), leaves = std::max(leaves, s);
    }
    if (line.last <= enters + nearness_ || line.first >= leaves - nearness_) return;
    for (CriticalLine& known : lines) {
        const double turn = known.n.x * line.n.y - known.n.y * line.n.x, reach = leaves - enters;
        if (std::abs(turn) * reach > nearness_) continue;
        const double side = dot(known.n, line.n) > 0 ? 1 : -1;
        const Vec2 middle = line.offset * line.n + (0.5 * (enters + leaves)) * Vec2{-line.n.y, line.n.x};
        if (std::abs(known.signed_distance(middle)) > nearness_) continue;
        known.first = std::min(known.first, side > 0 ? line.first : -line.last);
        known.last = std::max(known.last, side > 0 ? line.last : -line.first);
        return;
    }
    lines.push_back(line);
}

/// Adds lines on which corners of the source appear on edges of a blocker, and corners of the blocker on edges of the
/// source.
void CriticalLineFinder::add_sights(const PlaneFrame& frame, std::span<const Point> source, const SeenEdges& seen,
                                    std::vector<CriticalLine>& lines) {
    const ConvexBlocker& body = *seen.body;
    const std::size_t faces = body.faces.size();
    std::uint32_t any_corner = 0, any_edge = 0;
    const auto over_corners = [&](std::size_t k) {
        return seen.edges_over_corners.empty() ? ~0u : seen.edges_over_corners[k];
    };
    const auto over_edges = [&](std::uint32_t c) {
        return seen.corners_over_edges.empty() ? ~0u : seen.corners_over_edges[c];
    };
    for (std::size_t k = 0; k < seen.edges.size(); ++k) any_corner |= over_corners(k);
    for (std::uint32_t c : corners_) any_edge |= over_edges(c);
    if ((any_corner | any_edge) == 0) return;
    in_front_.resize(source.size() * faces);
    for (std::size_t s = 0; s < source.size(); ++s)
        for (std::size_t k = 0; k < faces; ++k) in_front_[s * faces + k] = body.faces[k].signed_distance(source[s]) > 0;
    const auto is_outline = [&](std::size_t s, const ConvexBlocker::Edge& e) {
        return e.right == ConvexBlocker::no_face || in_front_[s * faces + static_cast<std::size_t>(e.left)] !=
                                                        in_front_[s * faces + static_cast<std::size_t>(e.right)];
    };
    const auto shadow = [&](std::size_t s, std::uint32_t c) {
        const Vec2 from = frame.flat(source[s]), p = frame.flat(body.points[c]);
        const double high = frame.height(source[s]), low = std::max(0.0, frame.height(body.points[c]));
        return Shadow{p.x * high - from.x * low, p.y * high - from.y * low, high - low};
    };
    for (std::size_t s = 0; s < source.size(); ++s)
        for (std::size_t k = 0; k < seen.edges.size(); ++k) {
            const ConvexBlocker::Edge& e = body.edges[seen.edges[k]];
            if ((over_corners(k) & SeenEdges::bit(s)) && is_outline(s, e)) add(shadow(s, e.a), shadow(s, e.b), lines);
        }
    for (std::size_t s = 0; s < source.size(); ++s) {
        const std::size_t next = s + 1 == source.size() ? 0 : s + 1;
        if (!(any_edge & SeenEdges::bit(s))) continue;
        // If every face of the blocker has both ends of the source's edge on one side, its outline is the same from all
        // points of the edge.
        const bool alike = std::equal(&in_front_[s * faces], &in_front_[s * faces] + faces, &in_front_[next * faces]);
        const auto ends_outline = [&](std::uint32_t c) {
            return std::any_of(seen.edges.begin(), seen.edges.end(), [&](std::uint32_t k) {
                const ConvexBlocker::Edge& e = body.edges[k];
                return (e.a == c || e.b == c) && is_outline(s, e);
            });
        };
        for (std::uint32_t c : corners_)
            if ((over_edges(c) & SeenEdges::bit(s)) && (!alike || ends_outline(c)))
                add(shadow(s, c), shadow(next, c), lines);
    }
}

void CriticalLineFinder::find(const PlaneFrame& frame, std::span<const Vec2> receiver, std::span<const Point> source,
                              std::span<const SeenEdges> blockers, double nearness, std::size_t most,
                              std::vector<CriticalLine>& lines) {
    receiver_ = receiver, nearness_ = nearness, max_ = most;
    lines.clear();
    for (const SeenEdges& seen : blockers) {
        find_corners(seen);
        add_sights(frame, source, seen, lines);
        add_faces(frame, source, seen, lines);
    }
    for (const SeenEdges& far : blockers)
        for (const SeenEdges& near : blockers)
            if (far.body != near.body) add_gaps(frame, source, far, near, lines);
}

}  // namespace exitance
