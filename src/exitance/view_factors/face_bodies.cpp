#include "exitance/view_factors/face_bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <numeric>

namespace exitance {
namespace {

using Place = std::array<std::int64_t, 3>;

struct Side {
    Place low, high;
    std::uint32_t face;
    bool is_forward;
    bool joins(const Side& other) const { return low == other.low && high == other.high; }
    auto operator<=>(const Side&) const = default;
};

Place place_of(const Point& p, double grid) {
    return {std::llround(p.x / grid), std::llround(p.y / grid), std::llround(p.z / grid)};
}

std::vector<Side> sorted_sides(std::span<const ViewFace> faces, double grid) {
    std::vector<Side> sides;
    for (std::uint32_t k = 0; k < faces.size(); ++k) {
        const std::span<const Point> outline = faces[k].outline;
        for (std::size_t i = 0; i < outline.size(); ++i) {
            const Place from = place_of(outline[i], grid), to = place_of(outline[(i + 1) % outline.size()], grid);
            if (from != to) sides.push_back({std::min(from, to), std::max(from, to), k, from < to});
        }
    }
    std::sort(sides.begin(), sides.end());
    return sides;
}

}  // namespace

FaceBodies::FaceBodies(std::span<const ViewFace> faces, double slack) : body_(faces.size()) {
    constexpr double cells_per_slack = 4;
    const std::vector<Side> sides = sorted_sides(faces, cells_per_slack * slack);
    std::vector<std::uint32_t> parent(faces.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t k) {
        while (parent[k] != k) k = parent[k] = parent[parent[k]];
        return k;
    };
    std::vector<std::uint32_t> open;  // faces at edges that are not closed
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
        int balance = 0;
        for (last = first; last < sides.size() && sides[last].joins(sides[first]); ++last) {
            balance += sides[last].is_forward ? 1 : -1;
            const std::uint32_t a = root(sides[last].face), b = root(sides[first].face);
            parent[std::max(a, b)] = std::min(a, b);
        }
        if (balance != 0) open.push_back(sides[first].face);
    }
    std::vector<std::uint32_t> number(faces.size());
    for (std::uint32_t k = 0; k < faces.size(); ++k) {
        const std::uint32_t r = root(k);
        if (r == k) number[k] = static_cast<std::uint32_t>(all_.size()), all_.emplace_back();
        body_[k] = number[r];
        all_[body_[k]].box.add(faces[k].box);
        all_[body_[k]].faces.push_back(k);
    }
    for (const std::uint32_t k : open) all_[body_[k]].is_closed = false;
}

bool FaceBodies::has_body_inside(const ConvexBlocker& solid, std::span<const ViewFace> faces, double slack) const {
    Box box;
    for (const Point& p : solid.points) box.add(p);
    const auto is_inside = [&](std::uint32_t face) {
        for (const Plane& side : solid.faces)
            for (const Point& p : faces[face].outline)
                if (side.signed_distance(p) > -slack) return false;
        return true;
    };
    return std::any_of(all_.begin(), all_.end(), [&](const Body& body) {
        for (std::size_t k = 0; k < 3; ++k)
            if (body.box.lo[k] < box.lo[k] || body.box.hi[k] > box.hi[k]) return false;
        return std::all_of(body.faces.begin(), body.faces.end(), is_inside);
    });
}

}  // namespace exitance
