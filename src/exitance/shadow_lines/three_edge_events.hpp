#pragma once

#include <span>
#include <vector>

#include "exitance/shadow_lines/blocker_edges.hpp"
#include "exitance/shadow_lines/shadow_events.hpp"
#include "exitance/visibility/critical_lines.hpp"

namespace exitance {

/// Points of a receiver from which an edge of the source and two blocker edges appear to meet in one point. They form a
/// section of a conic, stored as a polyline in the receiver's plane coordinates, metres.
struct ThreeEdgeEvent {
    std::vector<Vec2> places;
    /// True if none of the source is visible on one side of the curve near that point, so that an umbra may end there.
    bool may_bound_umbra = false;
};

/// A rectangle of a receiver, in which events are searched.
struct EventReceiver {
    const PlaneFrame& frame;
    RegionId region;
    Vec2 lo, hi;  ///< Corners in the plane's coordinates, metres.
};

/// Finds the events of one source edge and two blocker edges (EEE). From each point q of the source's edge one line
/// passes through both blocker edges. Its position on each is a ratio of two functions linear in q. The part of the
/// source's edge whose lines meet both edges, in front of the receiver, therefore has a closed form. Other occluders on
/// such a line of sight hide that part of the conic. O(source edges x pairs of edges) tests of a few operations each;
/// the remaining pairs take O(log n) each. Source: [Heckbert92], [Drettakis94].
class ThreeEdgeEventFinder {
  public:
    /// Once `stop` is requested, the result is incomplete.
    ThreeEdgeEventFinder(const Occluders& occluders, const BlockerEdges& edges, const StopRequest* stop = nullptr)
        : occluders_(&occluders), edges_(&edges), stop_(stop) {}

    /// Appends the events of the edges numbered `among` inside the rectangle of the receiver.
    /// umbra_only  only events that may bound an umbra
    /// sagitta  maximum distance of a polyline from its conic, metres
    void find(const EventReceiver& receiver, const EventSource& source, std::span<const std::uint32_t> among,
              bool umbra_only, double sagitta, std::vector<ThreeEdgeEvent>& events);

  private:
    struct Interval {
        double first = 0, last = 1;
    };
    struct Sight {
        Point q, p, r;  ///< The points on the source's edge and on each blocker edge.
        Vec2 place;     ///< Point on the receiver, in plane coordinates.
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
    double sagitta_ = 0, min_ = 0;
};

}  // namespace exitance
