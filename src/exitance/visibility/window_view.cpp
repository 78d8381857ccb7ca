#include "exitance/visibility/window_view.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/limits.hpp"

namespace exitance {

bool looks_out_on_faces(const Occluders& occluders, PieceId source) {
    if (!occluders.is_window(source)) return false;
    const Plane& plane = occluders.pieces()[source].plane;
    const Box& box = occluders.scene().box();
    const Point farthest{plane.n.x > 0 ? box.lo.x : box.hi.x, plane.n.y > 0 ? box.lo.y : box.hi.y,
                         plane.n.z > 0 ? box.lo.z : box.hi.z};
    const auto is_beyond = [&](const Point& p) {
        return plane.signed_distance(p) < -coplanar_share * occluders.scene().size();
    };
    const std::vector<Pane>& panes = occluders.enclosure().others;
    return is_beyond(farthest) || std::any_of(panes.begin(), panes.end(), [&](const Pane& pane) {
               return std::any_of(pane.corners.begin(), pane.corners.end(), is_beyond);
           });
}

void WindowView::clip_by(const Plane& plane, std::vector<Point>& polygon) {
    clip(polygon, plane, buffer_);
    std::swap(polygon, buffer_);
}

/// side: 1 if `edges` are the window's, -1 if they are the receiver's.
void WindowView::add_separating_planes(std::span<const Point> edges, std::span<const Point> corners, double side,
                                       double slack) {
    for (std::size_t i = 0, m = edges.size(); i < m; ++i) {
        const Point &a = edges[i], &b = edges[i + 1 == m ? 0 : i + 1];
        for (const Point& c : corners) {
            const Vec3 normal = cross(b - a, c - a);
            const double length = norm(normal);
            if (length <= zero_sine * norm(b - a) * norm(c - a) || length == 0)
                continue;  // c is collinear with the edge
            Plane plane{normal / length, dot(normal, a) / length};
            const auto is_above = [&](std::span<const Point> points, double sign) {
                return std::all_of(points.begin(), points.end(),
                                   [&](const Point& p) { return sign * plane.signed_distance(p) >= -slack; });
            };
            for (const double sign : {side, -side}) {  // the window above, the receiver below
                if (!is_above(edges, sign * side) || !is_above(corners, -sign * side)) continue;
                planes_.push_back({sign * plane.n, sign * plane.offset - slack});
                break;
            }
        }
    }
}

/// Sets the planes of the view. Returns false if the receiver and the window do not face each other.
bool WindowView::set(const Occluders& occluders, const Facet& receiver, PieceId window) {
    const double slack = occluders.rounding();
    const Plane receiver_plane{receiver.n, dot(receiver.n, receiver.corners[0])};
    own_ = receiver.region;
    window_plane_ = occluders.pieces()[window].plane;
    receiver_.assign(receiver.corners.begin(), receiver.corners.end());
    window_.assign(occluders.corners(window).begin(), occluders.corners(window).end());
    clip_by(window_plane_, receiver_), clip_by(receiver_plane, window_);
    planes_.clear();
    if (receiver_.empty() || window_.empty()) return false;
    planes_.push_back({receiver.n, receiver_plane.offset - slack});
    planes_.push_back({-1.0 * window_plane_.n, -window_plane_.offset});
    add_separating_planes(window_, receiver_, 1, slack);
    add_separating_planes(receiver_, window_, -1, slack);
    return true;
}

bool WindowView::reaches_in(const Occluders& occluders, PieceId p) {
    const ConvexPiece& piece = occluders.pieces()[p];
    if (occluders.is_own(piece.region, own_)) return false;
    const std::span<const Point> corners = occluders.corners(p);
    const auto is_beyond = [&](const Point& c) { return window_plane_.signed_distance(c) < -piece.thickness; };
    if (std::none_of(corners.begin(), corners.end(), is_beyond)) return false;
    for (const Plane& plane : planes_)
        if (std::all_of(corners.begin(), corners.end(), [&](const Point& c) { return plane.signed_distance(c) <= 0; }))
            return false;
    part_.assign(corners.begin(), corners.end());
    for (const Plane& plane : planes_) {
        clip_by(plane, part_);
        if (part_.size() < 3) return false;
    }
    return true;
}

void WindowView::add(const Occluders& occluders, const Facet& receiver, PieceId window,
                     std::vector<PieceId>& candidates) {
    if (!set(occluders, receiver, window)) return;
    ConvexRegion region;
    for (const Plane& plane : planes_) region.add(plane);
    const std::size_t before = candidates.size();
    const auto look = [&](PieceId p) {
        const auto end = candidates.begin() + static_cast<std::ptrdiff_t>(before);
        if (std::find(candidates.begin(), end, p) == end && reaches_in(occluders, p)) candidates.push_back(p);
        return false;
    };
    for (const Occluders::Size size : {Occluders::Size::large, Occluders::Size::small})
        occluders.visit_region(size, region, look, -1.0 * window_plane_.n);
}

void WindowView::add(const Occluders& occluders, const Facet& receiver, PieceId window, std::span<const PieceId> from,
                     std::vector<PieceId>& candidates) {
    if (!set(occluders, receiver, window)) return;
    const std::size_t before = candidates.size();
    for (const PieceId p : from) {
        const auto end = candidates.begin() + static_cast<std::ptrdiff_t>(before);
        if (std::find(candidates.begin(), end, p) == end && reaches_in(occluders, p)) candidates.push_back(p);
    }
}

}  // namespace exitance
