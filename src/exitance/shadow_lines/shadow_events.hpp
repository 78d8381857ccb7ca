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

/// Where on a receiver the visible part of one source changes its corners: a stretch of a straight line in the
/// receiver's own coordinates, metres.
struct ShadowEvent {
    Vec2 a, b;
    bool is_kink = false;            ///< The light's slope breaks (D1), not only its curvature (D2).
    bool by_edge_of_source = false;  ///< An edge of the source over a blocker's corner (EV), not a corner over an edge.
    bool by_blockers_alone = false;  ///< A corner of a blocker over another edge of one (NEV), before the source.
    double width = 0;                ///< Of the half-shadow that begins here, metres.
    double gain = HUGE_VAL;          ///< What the source may bring beyond the edge at most, as EventBounds tells.
};

/// What may stand in the lines of sight to a source from its corners, in place of a search: the minimum candidate lists
/// of a receiver (bsp/minimum_lists.hpp), in front of others first.
struct WedgeLists {
    std::vector<std::vector<PieceId>> of_corner;  ///< From each corner of the source; an edge has those of its ends.
    std::vector<PieceId> of_all;
};

/// What the source may bring at most beyond each edge of a blocker, and what an event must bring to be looked for.
struct EventBounds {
    std::span<const double> gains = {};  ///< By edge, as they are numbered in `among`; empty: any.
    double least_bend = 0;               ///< Of events that bend light only (D2),
    /// or where these are eight times as long as the half-shadow is wide, which bisection would follow by more
    /// triangles than lines cost.
    double least_narrow_bend = HUGE_VAL;
    const StopRequest* stop = nullptr;  ///< Once it is requested, what is found is not complete.
    const WedgeLists* lists = nullptr;  ///< By what wedges are clipped; none: by what a tree of boxes finds.
};

/// The corners and edges of a source, the front of whose plane it shines into. A point alone is a source, too: then
/// its events are where light jumps.
struct EventSource {
    std::vector<std::vector<Point>> loops;
    Plane plane;
    RegionId region;
    bool is_point = false;
    double size = 0;  ///< Metres across.
};

/// Vertex-edge and edge-vertex events of discontinuity meshing [Heckbert92]; those of a blocker's corner over another
/// edge of a blocker in front of the source [Drettakis94]. Those of three edges: three_edge_events.hpp.
///
/// A corner of the source and an edge of a blocker span a wedge; an edge of the source and a corner of a blocker span
/// two, on either side of the corner. Each meets the receiver's plane in a line. What lies within the wedge hides
/// stretches of it: it is found in a tree of boxes, and what remains of the line is an event. O(corners (log n + hits))
/// a blocker's edge.
class ShadowEventFinder {
  public:
    ShadowEventFinder(const Occluders& occluders, const BlockerEdges& edges, const EventBounds& bounds = {})
        : occluders_(&occluders), edges_(&edges), bounds_(bounds) {}

    /// Appends the events of the blockers' edges numbered `among`, as far as they reach into the box lo..hi of the
    /// receiver. `own` is the receiver's region.
    void find(const PlaneFrame& receiver, RegionId own, Vec2 lo, Vec2 hi, const EventSource& source,
              std::span<const std::uint32_t> among, std::vector<ShadowEvent>& events);

    /// The same for corners of blockers over blockers' edges, in front of the source. O(corners edges), of which few
    /// reach the source.
    void find_non_emitter(const PlaneFrame& receiver, RegionId own, Vec2 lo, Vec2 hi, const EventSource& source,
                          std::span<const std::uint32_t> among, std::vector<ShadowEvent>& events);

    std::size_t wedges = 0;       ///< Looked at so far.
    std::size_t plane_tests = 0;  ///< Pieces of lists that a wedge's plane was held against.
    std::size_t too_weak = 0;     ///< Wedges of D2 events that were left out for what they may bring.

  private:
    /// A fan of sight lines: from `apex` through base + t along, t in [first, last]; `beyond`: lines end behind the
    /// apex (EV), else behind the base (VE).
    struct Wedge {
        Point apex, base;
        Vec3 along;
        double first = 0, last = 1;
        bool beyond = false;
        bool passes_apex = false;  ///< The apex is a blocker's corner: lines come from beyond it.
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
    /// The clock is looked at for every so many wedges only.
    bool is_stopped() {
        constexpr std::size_t wedges_a_look = 64;
        return bounds_.stop && ++asked_ % wedges_a_look == 0 && bounds_.stop->requested();
    }
    /// Does an event of so much light count? Those that only bend it count from a limit on.
    bool counts(const ShadowEvent& event) {
        const bool weak = is_weak(event) && event.gain < bounds_.least_narrow_bend;
        too_weak += weak;
        return !weak;
    }
    bool is_weak(const ShadowEvent& event) const {
        return !source_->is_point && !event.is_kink && !event.by_blockers_alone && event.gain < bounds_.least_bend;
    }
    /// The same of a stretch of it.
    bool is_long_enough(const ShadowEvent& event) const {
        constexpr double narrow = 8;
        const Vec2 d = event.b - event.a;
        return !is_weak(event) || dot(d, d) > narrow * narrow * event.width * event.width;
    }

    const Occluders* occluders_;
    const BlockerEdges* edges_;
    const PlaneFrame* frame_ = nullptr;
    const EventSource* source_ = nullptr;
    std::span<const std::uint32_t> among_;
    RegionId own_;
    Vec2 lo_, hi_;
    double least_ = 0;  ///< Metres: what is lower over a plane lies in it.
    std::vector<std::pair<double, double>> hidden_;
    EventBounds bounds_;
    std::array<std::span<const PieceId>, 2> lists_;  ///< Of the wedge at hand.
    std::size_t asked_ = 0;                          ///< How often whether to stop.
    std::vector<std::pair<std::uint32_t, Point>> corners_;
    std::vector<double> corner_gains_;                               ///< The most of the edges that end there.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_at_;  ///< Corner, edge; sorted.
};

}  // namespace exitance
