#pragma once

#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/shadow_lines/blocker_edges.hpp"
#include "exitance/visibility/critical_lines.hpp"
#include "exitance/visibility/occluders.hpp"

namespace exitance {

/// A segment on a receiver across which the set of corners of a source's visible part changes. In the receiver's plane
/// coordinates, metres.
struct ShadowEvent {
    Vec2 a, b;
    bool is_kink = false;  ///< Discontinuity of the slope of irradiance (D1); otherwise of its curvature (D2).
    /// EV event: an edge of the source over a blocker's corner. Otherwise VE: a corner of the source over an edge.
    bool by_edge_of_source = false;
    /// NEV event: a corner of a blocker over another blocker's edge, in front of the source.
    bool by_blockers_alone = false;
    double width = 0;        ///< Width of the penumbra that begins here, metres.
    double gain = HUGE_VAL;  ///< Upper bound of the source's contribution beyond the edge; see EventBounds::gains.
};

/// Possible occluders between a receiver and a source, used instead of a search, front to back (see BlockerSearch).
struct WedgeLists {
    /// Per corner of the source. An edge of the source uses the lists of both ends.
    std::vector<std::vector<PieceId>> of_corner;
    std::vector<PieceId> of_all;
};

/// Upper bounds of the source's contribution beyond each blocker edge, and the contribution below which events are
/// skipped.
struct EventBounds {
    std::span<const double> gains = {};  ///< Per edge, in the order of `among`; empty: unbounded.
    double min_bend = 0;                 ///< Minimum gain of events that change only the curvature (D2).
    /// Minimum gain of D2 events more than eight times as long as their penumbra is wide, if below `min_bend`:
    /// bisection would need more triangles for such events than cutting along the line.
    double min_narrow_bend = HUGE_VAL;
    const StopRequest* stop = nullptr;  ///< Once a stop is requested, the result is incomplete.
    const WedgeLists* lists = nullptr;  ///< Occluders that wedges are clipped by; null: those that the box tree finds.
};

/// Corners and edges of a source that emits into the front of its plane. A point source is a single point; its events
/// are discontinuities of irradiance itself.
struct EventSource {
    std::vector<std::vector<Point>> loops;
    Plane plane;
    RegionId region;
    bool is_point = false;
    double size = 0;  ///< Diameter, metres.
};

/// Finds the vertex-edge (VE) and edge-vertex (EV) events of discontinuity meshing [Heckbert92], and those of a
/// blocker's corner over a blocker's edge in front of the source (NEV) [Drettakis94]. For three-edge events see
/// three_edge_events.hpp.
///
/// A corner of the source and an edge of a blocker span a wedge. An edge of the source and a corner of a blocker span
/// two, one on each side of the corner. Each wedge meets the receiver's plane in a line. Occluders inside the wedge,
/// found in a bounding volume hierarchy, hide stretches of the line; the rest are events. O(corners (log n + hits)) per
/// blocker edge.
class ShadowEventFinder {
  public:
    ShadowEventFinder(const Occluders& occluders, const BlockerEdges& edges, const EventBounds& bounds = {})
        : occluders_(&occluders), edges_(&edges), bounds_(bounds) {}

    /// Appends the events of the blocker edges numbered `among` inside the box lo..hi of the receiver (plane
    /// coordinates, metres). `own`: the receiver's region.
    void find(const PlaneFrame& receiver, RegionId own, Vec2 lo, Vec2 hi, const EventSource& source,
              std::span<const std::uint32_t> among, std::vector<ShadowEvent>& events);

    /// Like find(), for corners of blockers over blocker edges in front of the source. O(corners edges), of which few
    /// reach the source.
    void find_non_emitter(const PlaneFrame& receiver, RegionId own, Vec2 lo, Vec2 hi, const EventSource& source,
                          std::span<const std::uint32_t> among, std::vector<ShadowEvent>& events);

    std::size_t wedges = 0;       ///< Number of wedges examined so far.
    std::size_t plane_tests = 0;  ///< Number of listed pieces tested against a wedge's plane.
    std::size_t too_weak = 0;     ///< Number of wedges of D2 events, and of their stretches, skipped as too weak.

  private:
    /// A fan of sight lines from `apex` through base + t along, t in [first, last]. `beyond`: the lines end behind the
    /// apex (EV); otherwise behind the base (VE).
    struct Wedge {
        Point apex, base;
        Vec3 along;
        double first = 0, last = 1;
        bool beyond = false;
        bool passes_apex = false;  ///< The apex is a blocker's corner, and the lines start beyond it.
    };
    void set(const PlaneFrame& receiver, RegionId own, Vec2 lo, Vec2 hi, const EventSource& source,
             std::span<const std::uint32_t> among);
    bool is_near_outline(std::uint32_t corner, const Point& from) const;
    bool clip_to_source(Wedge& wedge, const Vec3& normal) const;
    void add_corner_before_edge(std::uint32_t corner, const Point& w, const BlockerEdges::Edge& edge, bool beyond,
                                std::vector<ShadowEvent>& events);
    void add_corner_over_edge(const Point& s, const Vec3& before, const Vec3& after, const BlockerEdges::Edge& edge,
                              double gain, std::vector<ShadowEvent>& events);
    void add_edge_over_corner(const Point& q0, const Point& q1, std::size_t corner, std::vector<ShadowEvent>& events);
    bool clip_to_box(Wedge& wedge, double height) const;
    ConvexRegion fan(const Wedge& wedge, const Vec3& normal, double side) const;
    void keep_visible(const Wedge& wedge, ShadowEvent event, std::vector<ShadowEvent>& events);
    bool blank(const Wedge& wedge, const Vec3& normal, PieceId piece);
    Vec2 shadow(const Wedge& wedge, double t) const;
    bool limit(double at_zero, double rate, double& first, double& last) const;
    /// Checks the stop request only once every 64 wedges.
    bool is_stopped() {
        constexpr std::size_t wedges_a_look = 64;
        return bounds_.stop && ++asked_ % wedges_a_look == 0 && bounds_.stop->requested();
    }
    /// Returns whether an event's gain is large enough: D2 events need `min_bend`, or `min_narrow_bend` if they
    /// turn out to be long enough (is_long_enough).
    bool counts(const ShadowEvent& event) {
        const bool weak = is_weak(event) && event.gain < bounds_.min_narrow_bend;
        too_weak += weak;
        return !weak;
    }
    bool is_weak(const ShadowEvent& event) const {
        return !source_->is_point && !event.is_kink && !event.by_blockers_alone && event.gain < bounds_.min_bend;
    }
    /// Returns whether an event is long enough to keep: any event that is not weak, or one more than eight times as
    /// long as its penumbra is wide.
    bool is_long_enough(const ShadowEvent& event) const {
        constexpr double narrow = 8;
        const Vec2 d = event.b - event.a;
        return !is_weak(event) || dot(d, d) > narrow * narrow * event.width * event.width;
    }

    const Occluders* occluders_;
    const BlockerEdges* edges_;
    const PlaneFrame* frame_ = nullptr;
    const EventSource* source_ = nullptr;
    RegionId own_;
    Vec2 lo_, hi_;
    double min_ = 0;  ///< Metres: points nearer to a plane than this are in it.
    std::vector<std::pair<double, double>> hidden_;
    EventBounds bounds_;
    std::array<std::span<const PieceId>, 2> lists_;  ///< Candidate lists for the current wedge.
    std::size_t asked_ = 0;                          ///< Number of calls of is_stopped().
    std::vector<std::pair<std::uint32_t, Point>> corners_;
    std::vector<double> corner_gains_;  ///< Per corner: the largest gain of the edges that end there.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_at_;  ///< Pairs of a corner and an edge at it, sorted.
};

}  // namespace exitance
