#include "exitance/lab/bsp/source_orderings.hpp"

#include <algorithm>

#include "exitance/base/check.hpp"

namespace exitance {

SourceOrderings::SourceOrderings(const BspTree& tree, std::span<const Point> corners)
    : tree_(&tree), appears_(tree.nodes().size(), 0), front_(tree.nodes().size(), 0) {
    EXI_CHECK(corners.size() <= 64);
    for (std::size_t k = 0; k < corners.size(); ++k) {
        std::vector<std::uint32_t>& order = orders_.emplace_back();
        std::vector<std::uint32_t>& place = places_.emplace_back(tree.nodes().size());
        order.reserve(tree.nodes().size());
        tree.front_to_back(corners[k], [&](std::uint32_t node, int side) {
            place[node] = static_cast<std::uint32_t>(order.size());
            order.push_back(node);
            if (side != 0) appears_[node] |= std::uint64_t(1) << k;
            if (side > 0) front_[node] |= std::uint64_t(1) << k;
        });
    }
}

bool SourceOrderings::turns_front_to(std::uint32_t node, std::size_t corner) const {
    if (!(appears_[node] >> corner & 1)) return false;
    const bool sees_front = front_[node] >> corner & 1;
    const auto fragments = tree_->fragments(tree_->nodes()[node]);
    return std::any_of(fragments.begin(), fragments.end(),
                       [&](const BspTree::Fragment& f) { return f.faces_front == sees_front; });
}

std::vector<std::uint32_t> SourceOrderings::candidates(std::uint32_t node, bool facing) const {
    std::vector<std::uint32_t> out;
    for (std::size_t k = 0; k < orders_.size(); ++k)
        for (std::uint32_t i = 0; i < places_[k][node]; ++i) {
            const std::uint32_t other = orders_[k][i];
            if (facing ? turns_front_to(other, k) : (appears_[other] >> k & 1) != 0) out.push_back(other);
        }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

std::vector<PieceId> SourceOrderings::candidate_pieces(std::uint32_t node, bool facing) const {
    std::vector<PieceId> out;
    for (std::uint32_t other : candidates(node, facing))
        for (const BspTree::Fragment& f : tree_->fragments(tree_->nodes()[other])) out.push_back(f.piece);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

std::vector<Point> convex_hull(std::span<const Point> points, const Normal& n) {
    if (points.size() < 3) return {points.begin(), points.end()};
    const Frame frame(n);
    std::vector<std::pair<Vec2, Point>> sorted;
    for (const Point& p : points) sorted.push_back({{dot(frame.u, p), dot(frame.v, p)}, p});
    std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
        return std::pair(a.first.x, a.first.y) < std::pair(b.first.x, b.first.y);
    });
    std::vector<std::pair<Vec2, Point>> hull;
    const auto add = [&](const std::pair<Vec2, Point>& p, std::size_t least) {
        while (hull.size() >= least &&
               cross(hull.back().first - hull[hull.size() - 2].first, p.first - hull.back().first) <= 0)
            hull.pop_back();
        hull.push_back(p);
    };
    for (const auto& p : sorted) add(p, 2);
    const std::size_t lower = hull.size() + 1;
    for (std::size_t i = sorted.size() - 1; i-- > 0;) add(sorted[i], lower);
    hull.pop_back();
    std::vector<Point> out;
    for (const auto& p : hull) out.push_back(p.second);
    return out;
}

}  // namespace exitance
