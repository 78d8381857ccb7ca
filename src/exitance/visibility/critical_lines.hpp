#pragma once

#include <span>
#include <vector>

#include "exitance/base/vec.hpp"
#include "exitance/visibility/convex_blockers.hpp"

namespace exitance {

/// A straight line on a receiver across which the set of corners of a source's visible part changes, so that the form
/// factor has a kink. Only the stretch between `first` and `last` matters. In the receiver's plane coordinates, metres.
struct CriticalLine {
    Vec2 n;  ///< The line is n . p = offset, |n| = 1; its direction is (-n.y, n.x).
    double offset = 0;
    double first = 0, last = 0;  ///< Ends of the relevant part of the line, as values of along().

    double signed_distance(Vec2 p) const { return dot(n, p) - offset; }
    double along(Vec2 p) const { return -n.y * p.x + n.x * p.y; }
};

/// A receiver's plane with 2D coordinates in it.
struct PlaneFrame {
    Point origin;
    Vec3 u, v;
    Normal n;

    PlaneFrame(const Point& o, const Normal& normal) : origin(o), n(normal) {
        const Frame frame(normal);
        u = frame.u, v = frame.v;
    }
    Vec2 flat(const Point& p) const { return {dot(u, p - origin), dot(v, p - origin)}; }
    double height(const Point& p) const { return dot(n, p - origin); }
    Point at(Vec2 p) const { return origin + p.x * u + p.y * v; }
};

/// A blocker, with those of its edges that may appear in front of the source.
struct SeenEdges {
    const ConvexBlocker* body;
    std::span<const std::uint32_t> edges;  ///< Indices into body->edges.
    /// Bit masks of visibility changes across the receiver. Per entry of `edges`: the corners of the source that are
    /// visible over the edge from some points of the receiver and not from others. Per corner of the blocker: the edges
    /// of the source that it crosses in the same sense. Bit s is corner or edge s; those from 31 on share the last bit.
    std::span<const std::uint32_t> edges_over_corners, corners_over_edges;

    static constexpr std::uint32_t bit(std::size_t s) { return 1u << (s < 31 ? s : 31); }
};

/// Finds the critical lines that cross a convex receiver:
///  - VE: a corner of the source appears on an edge of a blocker's silhouette;
///  - EV: an edge of the source appears on a blocker's corner;
///  - NEV: a blocker's corner appears on an edge of another blocker in front of the source, or on an edge of its own
///  body (a face of which is then seen edge-on).
/// Three-edge events of discontinuity meshing are omitted.
/// nearness  metres: lines closer to each other than this are merged
/// most  limit on the number of lines; their order depends on the input only
/// Blockers must be in front of the source's plane. O(corners^2) per blocker, counting visible edges only. Source:
/// [Heckbert92].
class CriticalLineFinder {
  public:
    void find(const PlaneFrame& frame, std::span<const Vec2> receiver, std::span<const Point> source,
              std::span<const SeenEdges> blockers, double nearness, std::size_t most, std::vector<CriticalLine>& lines);

  private:
    /// Projection of a point onto the receiver's plane, in homogeneous coordinates. Weight <= 0: at infinity or beyond.
    struct Shadow {
        double x, y, weight;
    };
    void add_sights(const PlaneFrame& frame, std::span<const Point> source, const SeenEdges& seen,
                    std::vector<CriticalLine>& lines);
    void add_gaps(const PlaneFrame& frame, std::span<const Point> source, const SeenEdges& far, const SeenEdges& near,
                  std::vector<CriticalLine>& lines);
    void add_faces(const PlaneFrame& frame, std::span<const Point> source, const SeenEdges& blocker,
                   std::vector<CriticalLine>& lines);
    void find_corners(const SeenEdges& blocker);
    bool crosses_receiver(const CriticalLine& line) const;
    void keep(CriticalLine line, std::vector<CriticalLine>& lines) const;
    void add(const Shadow& a, const Shadow& b, std::vector<CriticalLine>& lines) const;

    std::span<const Vec2> receiver_;
    double nearness_ = 0;
    std::size_t max_ = 0;
    std::vector<std::uint8_t> in_front_, is_seen_;
    std::vector<std::uint32_t> corners_;  ///< End points of the edges of the current blocker.
};

}  // namespace exitance
