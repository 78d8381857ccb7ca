#include <algorithm>
#include <cmath>

#include "exitance/shadow_lines/shadow_events.hpp"

namespace exitance {

/// Returns whether any edge that ends in the corner is an outline as seen from a point.
bool ShadowEventFinder::is_near_outline(std::uint32_t corner, const Point& from) const {
    auto at = std::lower_bound(edges_at_.begin(), edges_at_.end(), std::pair{corner, 0u});
    for (; at != edges_at_.end() && at->first == corner; ++at)
        if (edges_->is_outline(edges_->edges()[at->second], from)) return true;
    return false;
}

/// Restricts the wedge to lines of sight from the source. The wedge's plane cuts the source in a segment whose ends
/// limit the parameter; for a non-convex source, the stretch from the first to the last cut is used.
bool ShadowEventFinder::clip_to_source(Wedge& wedge, const Vec3& normal) const {
    const Vec3 b = wedge.base - wedge.apex;
    const double area = dot(cross(b, wedge.along), normal);
    if (area == 0) return false;
    double from = HUGE_VAL, to = -HUGE_VAL;
    for (const auto& loop : source_->loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Point &p = loop[i], &q = loop[(i + 1) % loop.size()];
            const double dp = dot(normal, p - wedge.apex), dq = dot(normal, q - wedge.apex);
            if ((dp > 0) == (dq > 0)) continue;
            const Point at = p + (dp / (dp - dq)) * (q - p);
            // p = apex + m (base - apex + t along): before the apex m < 0, beyond the edge m > 1
            const double m = dot(cross(at - wedge.apex, wedge.along), normal) / area;
            const double t = dot(cross(b, at - wedge.apex), normal) / area / m;
            // the two lines intersect in front of the blocker: rounding near the source's plane
            if (wedge.beyond ? !(m > 1) : !(m < 0)) return false;
            from = std::min(from, t), to = std::max(to, t);
        }
    wedge.first = std::max(wedge.first, from), wedge.last = std::min(wedge.last, to);
    return wedge.first < wedge.last;
}

/// Adds the event of a blocker's corner w over an edge. `beyond`: the edge is between the corner and the source;
/// otherwise the corner is between the source and the edge.
void ShadowEventFinder::add_corner_before_edge(std::uint32_t corner, const Point& w, const BlockerEdges::Edge& edge,
                                               bool beyond, std::vector<ShadowEvent>& events) {
    const double height = frame_->height(w), ha = frame_->height(edge.a), hb = frame_->height(edge.b);
    if (beyond ? std::max(ha, hb) <= height : std::min(ha, hb) >= height) return;
    const Vec3 plane = cross(edge.a - w, edge.b - w);
    const double size = norm(plane);
    if (!(size > edges_->tolerance() * norm(edge.b - edge.a))) return;  // the corner lies on the edge's line
    Wedge wedge{w, edge.a, edge.b - edge.a, 0, 1, beyond, true};
    if (!limit(ha - min_, hb - ha, wedge.first, wedge.last)) return;
    const double da = source_->plane.signed_distance(edge.a), db = source_->plane.signed_distance(edge.b);
    if (!limit(da - min_, db - da, wedge.first, wedge.last)) return;
    if (!clip_to_source(wedge, plane / size) || !clip_to_box(wedge, height)) return;
    const Point middle = edge.a + 0.5 * (wedge.first + wedge.last) * wedge.along;
    if (!edges_->is_outline(edge, w) || !is_near_outline(corner, middle)) return;
    ShadowEvent event;
    event.by_blockers_alone = true;
    keep_visible(wedge, event, events);
}

void ShadowEventFinder::find_non_emitter(const PlaneFrame& receiver, RegionId own, Vec2 lo, Vec2 hi,
                                         const EventSource& source, std::span<const std::uint32_t> among,
                                         std::vector<ShadowEvent>& events) {
    if (source.is_point) return;
    set(receiver, own, lo, hi, source, among);
    lists_ = {};
    if (bounds_.lists) lists_[0] = bounds_.lists->of_all;
    for (const auto& [number, w] : corners_) {
        if (is_stopped()) return;
        if (frame_->height(w) <= min_ || source.plane.signed_distance(w) <= min_) continue;
        for (const std::uint32_t e : among) {
            const BlockerEdges::Edge& edge = edges_->edges()[e];
            if (edge.ends[0] == number || edge.ends[1] == number) continue;
            for (const bool beyond : {false, true}) add_corner_before_edge(number, w, edge, beyond, events);
        }
    }
}

}  // namespace exitance
