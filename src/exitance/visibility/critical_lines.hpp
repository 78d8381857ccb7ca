#pragma once

#include <span>
#include <vector>

#include "exitance/base/vec.hpp"
#include "exitance/visibility/convex_blockers.hpp"

namespace exitance {

/// A line on a receiver across which the visible part of a source changes its corners, so that the form factor bends.
/// It matters between two places along it only. In the receiver's own coordinates.
struct CriticalLine {
    Vec2 n;  ///< The line is n . p = offset, |n| = 1; along it runs (-n.y, n.x).
    double offset = 0;
    double first = 0, last = 0;  ///< Where along it something changes.

    double signed_distance(Vec2 p) const { return dot(n, p) - offset; }
    double along(Vec2 p) const { return -n.y * p.x + n.x * p.y; }
};

/// A receiver's plane with coordinates of its own.
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

/// A blocker, and those of its edges that may be seen before the source.
struct SeenEdges {
    const ConvexBlocker* body;
    std::span<const std::uint32_t> edges;  ///< In the blocker's.
    /// Which corners of the source are seen over an edge from somewhere on the receiver, and not from elsewhere; and
    /// over which of the source's edges a corner of the blocker is. A bit each, those past the 31st share the last.
    std::span<const std::uint32_t> edges_over_corners, corners_over_edges;

    static constexpr std::uint32_t bit(std::size_t s) { return 1u << (s < 31 ? s : 31); }
};

/// The lines that cross a convex receiver on which a corner of the source is seen over an edge of a blocker's
/// silhouette, an edge of the source over a blocker's corner (the VE and EV events of discontinuity meshing), or a
/// blocker's corner over another's edge in front of the source, or over its own body's (NEV). Events of three edges are
/// left out.
/// Source: [Heckbert92]. Lines nearer than `nearness` (metres) to each other are one; at most `most` are given, in an
/// order that depends on the input alone. Blockers lie in front of the source's plane. O(corners^2) a blocker, of edges
/// that are seen.
class CriticalLineFinder {
  public:
    void find(const PlaneFrame& frame, std::span<const Vec2> receiver, std::span<const Point> source,
              std::span<const SeenEdges> blockers, double nearness, std::size_t most, std::vector<CriticalLine>& lines);

  private:
    /// A point of the plane times its weight; a place at infinity or beyond has weight <= 0.
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
    std::size_t most_ = 0;
    std::vector<std::uint8_t> in_front_, is_seen_;
    std::vector<std::uint32_t> corners_;  ///< Ends of the edges at hand.
};

}  // namespace exitance
