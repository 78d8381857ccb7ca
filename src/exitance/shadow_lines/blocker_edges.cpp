#include "exitance/shadow_lines/blocker_edges.hpp"

#include <algorithm>
#include <unordered_map>

#include "exitance/scene/joining/weld.hpp"

namespace exitance {

BlockerEdges::BlockerEdges(const Occluders& occluders) : tolerance_(1e-8 * occluders.scene().size()) {
    const Scene& scene = occluders.scene();
    std::vector<Point> points;
    for (const Region& region : scene.regions())
        for (const auto& loop : region.loops) points.insert(points.end(), loop.begin(), loop.end());
    const std::vector<std::uint32_t> first_at = weld(points, tolerance_);
    corner_count_ = points.size();
    std::unordered_map<std::uint64_t, std::uint32_t> known;
    std::uint32_t base = 0;
    for (const Region& region : scene.regions()) {
        first_.push_back(static_cast<std::uint32_t>(of_region_.size()));
        for (const auto& loop : region.loops) {
            const auto m = static_cast<std::uint32_t>(loop.size());
            for (std::uint32_t i = 0; i < m; ++i) {
                const std::uint32_t a = first_at[base + i], b = first_at[base + (i + 1) % m];
                if (a == b) continue;
                const std::uint64_t key = std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
                const auto [at, fresh] = known.try_emplace(key, static_cast<std::uint32_t>(edges_.size()));
                if (fresh) edges_.push_back({points[a], points[b], {a, b}});
                of_region_.push_back(at->second);
            }
            base += m;
        }
    }
    first_.push_back(static_cast<std::uint32_t>(of_region_.size()));
    find_sheets(occluders);
}

void BlockerEdges::find_sheets(const Occluders& occluders) {
    std::vector<Box> boxes;
    for (const PieceId p : occluders.pieces().ids()) {
        if (occluders.is_distant(p)) continue;
        Box& box = boxes.emplace_back();
        for (const Point& corner : occluders.corners(p)) box.add(corner);
    }
    const Bvh tree(boxes);
    const Vec3 slack = Vec3{1, 1, 1} * tolerance_;
    for (Edge& edge : edges_) {
        edge.first_sheet = static_cast<std::uint32_t>(sheets_.size());
        const Point middle = 0.5 * (edge.a + edge.b);
        tree.visit_box({middle - slack, middle + slack}, [&](std::uint32_t i) {
            add_sheets(occluders.pieces()[PieceId(i)], occluders.corners(PieceId(i)), edge);
        });
        edge.sheet_count = static_cast<std::uint32_t>(sheets_.size()) - edge.first_sheet;
    }
}

/// A piece that contains the edge's middle is on one side of the edge if the edge is on its border, and on both
/// otherwise.
void BlockerEdges::add_sheets(const ConvexPiece& piece, std::span<const Point> corners, Edge& edge) {
    const Point middle = 0.5 * (edge.a + edge.b);
    const Vec3 along = edge.b - edge.a;
    const double length = norm(along);
    if (std::abs(piece.plane.signed_distance(middle)) > tolerance_) return;
    if (std::abs(dot(piece.plane.n, along)) > 2 * tolerance_) return;  // the edge passes through the piece
    bool on_border = false;
    Vec3 inwards;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point& p = corners[i];
        const Vec3 border = corners[(i + 1) % corners.size()] - p;
        const double l = norm(border);
        if (!(l > 0)) continue;
        const Vec3 inside = cross(piece.plane.n, border) / l;
        const double depth = dot(inside, middle - p);
        if (depth < -tolerance_) return;
        if (depth <= tolerance_ && norm(cross(border, along)) <= 4 * tolerance_ * std::max(l, length))
            on_border = true, inwards = inside;
    }
    if (on_border) {
        sheets_.push_back(inwards);
        return;
    }
    const Vec3 across = cross(piece.plane.n, along) / length;
    sheets_.push_back(across), sheets_.push_back(-across);
}

std::pair<bool, bool> BlockerEdges::hidden_sides(const Edge& edge, const Point& p) const {
    const Vec3 plane = cross(edge.a - p, edge.b - p);
    const double least = 1e-9 * norm(plane);
    bool left = false, right = false;
    for (std::uint32_t i = edge.first_sheet; i < edge.first_sheet + edge.sheet_count; ++i) {
        const double side = dot(plane, sheets_[i]);
        left |= side > least, right |= side < -least;
    }
    return {left, right};
}

bool BlockerEdges::is_outline(const Edge& edge, const Point& p) const {
    const auto [left, right] = hidden_sides(edge, p);
    return !(left && right);
}

int BlockerEdges::free_side(const Edge& edge, const Point& p) const {
    const auto [left, right] = hidden_sides(edge, p);
    return left == right ? 0 : left ? -1 : 1;
}

}  // namespace exitance
