#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/shadow_lines/blocker_edges.hpp"
#include "exitance/shadow_lines/shadow_events.hpp"
#include "exitance/visibility/critical_lines.hpp"

namespace exitance {

/// A line.
struct SightLine {
    Point at;
    Vec3 along;
};

/// Places on a receiver from which an edge of the source and two edges of blockers are seen in one line: a stretch of a
/// conic as a polyline, in the receiver's own coordinates, metres.
struct ThreeEdgeEvent {
    std::vector<Vec2> places;
    /// Next to the place where the three meet nothing of the source is seen on one side of it, so that an umbra may end
    /// there.
    bool may_bound_umbra = false;
};

/// Events of an edge of the source and two of blockers (EEE). From a point q of the source's edge there is one line
/// through both others; it meets each where a ratio of two functions linear in q's place says, so that the part of the
/// source's edge from which both are met, in front of the receiver, is known without a search. What else stands in such
/// a line of sight hides that part of the conic. O(source's edges x pairs of edges) tests of a few operations, of which
/// what remains is O(log n) each. Source: [Heckbert92], [Drettakis94].
class ThreeEdgeEventFinder {
  public:
    /// Once `stop` is requested, what is found is not complete.
    ThreeEdgeEventFinder(const Occluders& occluders, const BlockerEdges& edges, const StopRequest* stop = nullptr)
        : occluders_(&occluders), edges_(&edges), stop_(stop) {}

    /// Appends events of the edges numbered `among` within the box lo..hi of the receiver. With `umbra_only` those that
    /// may bound an umbra. `sagitta`: how far a polyline may be off its conic, metres.
    void find(const PlaneFrame& receiver, RegionId own, Vec2 lo, Vec2 hi, const EventSource& source,
              std::span<const std::uint32_t> among, bool umbra_only, double sagitta,
              std::vector<ThreeEdgeEvent>& events);

  private:
    struct Interval {
        double first = 0, last = 1;
    };
    struct Sight {
        Point q, p, r;  ///< On the source, on each edge.
        Vec2 place;     ///< On the receiver.
        bool is_free = false;
    };
    Sight sight(double s, const Point& q0, const Point& q1, const BlockerEdges::Edge& e,
                const BlockerEdges::Edge& f) const;
    bool is_hidden(const Sight& sight, const Point& end) const;
    bool bounds_umbra(const Sight& sight, const Point& q0, const Point& q1, const BlockerEdges::Edge& e,
                      const BlockerEdges::Edge& f) const;
    void follow(const Point& q0, const Point& q1, const BlockerEdges::Edge& e, const BlockerEdges::Edge& f,
                Interval part, std::vector<ThreeEdgeEvent>& events) const;

    const Occluders* occluders_;
    const BlockerEdges* edges_;
    const StopRequest* stop_;
    const PlaneFrame* frame_ = nullptr;
    const EventSource* source_ = nullptr;
    RegionId own_;
    Vec2 lo_, hi_;
    bool umbra_only_ = true;
    double sagitta_ = 0, least_ = 0;
};

/// The determinant of the three planes through x and each line: 0 where one line of sight from x meets all three. It is
/// quadratic in x, its cubic part vanishes.
double three_line_determinant(const Point& x, const std::array<SightLine, 3>& lines);

}  // namespace exitance
