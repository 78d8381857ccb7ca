#include "exitance/lab/bsp/minimum_lists.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/polygon.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_corners = 64;  // bits of a mask

/// A rectangle in the plane of the points that contains all of them.
std::vector<Point> rectangle_around(std::span<const Point> points, const Normal& n) {
    const Frame frame(n);
    Vec2 lo{HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL};
    for (const Point& p : points) {
        const Vec2 at{dot(frame.u, p - points[0]), dot(frame.v, p - points[0])};
        lo = {std::min(lo.x, at.x), std::min(lo.y, at.y)}, hi = {std::max(hi.x, at.x), std::max(hi.y, at.y)};
    }
    const auto corner = [&](double u, double v) { return points[0] + u * frame.u + v * frame.v; };
    return {corner(lo.x, lo.y), corner(hi.x, lo.y), corner(hi.x, hi.y), corner(lo.x, hi.y)};
}

/// Returns whether two convex polygons in one plane overlap by more than `slack` (metres). Each is counter-clockwise
/// about n or about -n.
bool overlap(std::span<const Point> a, std::span<const Point> b, const Normal& n, double slack) {
    const auto separates = [&](std::span<const Point> edges, std::span<const Point> others) {
        const double turn = dot(area_vector(edges), n) < 0 ? -1 : 1;
        for (std::size_t i = 0; i < edges.size(); ++i) {
            const Vec3 along = edges[(i + 1) % edges.size()] - edges[i];
            const Vec3 inward = turn * cross(n, along);
            const double length = norm(inward);
            if (!(length > 0)) continue;
            if (std::all_of(others.begin(), others.end(),
                            [&](const Point& p) { return dot(inward, p - edges[i]) <= slack * length; }))
                return true;
        }
        return false;
    };
    return !separates(a, b) && !separates(b, a);
}

}  // namespace

MinimumLists::MinimumLists(const Occluders& occluders, std::span<const std::vector<Point>> sources,
                           std::span<const Normal> normals)
    : occluders_(&occluders), tree_(occluders) {
    for (std::size_t s = 0; s < sources.size(); ++s) {
        has_own_corners_.push_back(sources[s].size() <= max_corners);
        orderings_.emplace_back(tree_, has_own_corners_.back() ? sources[s] : rectangle_around(sources[s], normals[s]));
    }
    find_places();
}

void MinimumLists::find_places() {
    const std::size_t pieces = occluders_->pieces().size();
    first_place_.assign(pieces + 1, 0);
    for (const BspTree::Fragment& f : tree_.fragments()) ++first_place_[f.piece.value + 1];
    for (std::size_t p = 0; p < pieces; ++p) first_place_[p + 1] += first_place_[p];
    places_.resize(tree_.fragments().size());
    std::vector<std::uint32_t> next(first_place_.begin(), first_place_.end() - 1);
    for (std::uint32_t n = 0; n < tree_.nodes().size(); ++n) {
        const BspTree::Node& node = tree_.nodes()[n];
        for (std::uint32_t f = node.first_fragment; f < node.first_fragment + node.fragment_count; ++f)
            places_[next[tree_.fragments()[f].piece.value]++] = {n, f};
    }
}

MinimumLists::Limits MinimumLists::limits(std::size_t source, RegionId region) const {
    const SourceOrderings& orderings = orderings_[source];
    Limits out(orderings.corner_count(), 0);
    for (const PieceId p : occluders_->pieces(region))
        for (const Place& place : places(p))
            for (std::size_t k = 0; k < out.size(); ++k) out[k] = std::max(out[k], orderings.place(k, place.node));
    return out;
}

MinimumLists::Limits MinimumLists::limits(std::size_t source, RegionId region, std::span<const Point> part,
                                          const Normal& n) const {
    const SourceOrderings& orderings = orderings_[source];
    Limits out(orderings.corner_count(), 0);
    bool any = false;
    for (const PieceId p : occluders_->pieces(region))
        for (const Place& place : places(p)) {
            if (!overlap(part, tree_.outline(tree_.fragments()[place.fragment]), n, 0)) continue;
            any = true;
            for (std::size_t k = 0; k < out.size(); ++k) out[k] = std::max(out[k], orderings.place(k, place.node));
        }
    return any ? out : limits(source, region);
}

std::uint64_t MinimumLists::stands_before(std::size_t source, PieceId piece, const Limits& limits) const {
    const SourceOrderings& orderings = orderings_[source];
    std::uint64_t out = 0;
    for (const Place& place : places(piece)) {
        const std::uint64_t appears = orderings.appears(place.node);
        for (std::size_t k = 0; k < limits.size(); ++k)
            if ((appears >> k & 1) && orderings.place(k, place.node) < limits[k]) out |= std::uint64_t(1) << k;
    }
    return out;
}

std::vector<PieceId> MinimumLists::in_order(std::size_t source, std::size_t corner, const Limits& limits) const {
    const SourceOrderings& orderings = orderings_[source];
    std::vector<PieceId> out;
    std::vector<bool> known(occluders_->pieces().size());
    for (const std::uint32_t n : orderings.order(corner).first(limits[corner]))
        for (const BspTree::Fragment& f : tree_.fragments(tree_.nodes()[n])) {
            if (known[f.piece.value] || occluders_->is_distant(f.piece)) continue;
            known[f.piece.value] = true;
            out.push_back(f.piece);
        }
    return out;
}

}  // namespace exitance
