#include "exitance/scene/outline_repair.hpp"

#include <algorithm>
#include <unordered_map>

#include "exitance/scene/joining/border.hpp"
#include "exitance/scene/joining/outline.hpp"

namespace exitance {
namespace {

bool repeats_a_corner(std::span<const std::uint32_t> outline) {
    std::vector<std::uint32_t> sorted(outline.begin(), outline.end());
    std::sort(sorted.begin(), sorted.end());
    return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

std::vector<Point> places(std::span<const Point> points, std::span<const std::uint32_t> outline) {
    std::vector<Point> out;
    out.reserve(outline.size());
    for (std::uint32_t c : outline) out.push_back(points[c]);
    return out;
}

/// A loop within an outline: its own corners, and the range of the outline that contains it and its inner loops.
struct Loop {
    std::size_t first, end;
    std::vector<std::uint32_t> corners;
};

/// Returns the loops of an outline that begins at a corner of its rim: inner ones first, the rim last, without bridges.
std::vector<Loop> loops_of(std::span<const std::uint32_t> outline) {
    std::vector<Loop> loops;
    std::vector<std::size_t> open;  // positions in the outline that are not yet part of a loop
    std::unordered_map<std::uint32_t, std::size_t> place_of;  // position of each point in `open`
    const auto close = [&](std::size_t from, std::size_t end) {
        Loop loop{open[from], end, {}};
        for (std::size_t k = from; k < open.size(); ++k) loop.corners.push_back(outline[open[k]]);
        if (loop.corners.size() > 2) loops.push_back(std::move(loop));
    };
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const auto [seen, is_new] = place_of.try_emplace(outline[i], open.size());
        if (is_new) {
            open.push_back(i);
            continue;
        }
        close(seen->second, i);
        for (std::size_t k = seen->second + 1; k < open.size(); ++k) place_of.erase(outline[open[k]]);
        open.resize(seen->second + 1);
    }
    close(0, outline.size());
    return loops;
}

/// Returns a corner of `loop` that is not in `other`; the first corner if there is none.
std::uint32_t corner_apart(const Loop& loop, const Loop& other) {
    for (std::uint32_t c : loop.corners)
        if (std::find(other.corners.begin(), other.corners.end(), c) == other.corners.end()) return c;
    return loop.corners[0];
}

}  // namespace

std::size_t turn_holes(std::span<const Point> points, const Normal& n, std::vector<std::uint32_t>& outline) {
    if (!repeats_a_corner(outline)) return 0;
    const Frame frame(n);
    // The farthest corner in any direction belongs to the rim.
    std::rotate(outline.begin(),
                std::max_element(outline.begin(), outline.end(),
                                 [&](auto a, auto b) { return dot(points[a], frame.u) < dot(points[b], frame.u); }),
                outline.end());
    constexpr std::size_t max_loops = 1000;  // limited, since each loop is compared with all others
    std::size_t turned = 0;
    for (bool again = true; again;) {
        again = false;
        const std::vector<Loop> loops = loops_of(outline);
        if (loops.size() > max_loops) return turned;
        for (std::size_t i = 0; i + 1 < loops.size() && !again; ++i) {
            if (dot(area_vector(places(points, loops[i].corners)), n) <= 0) continue;
            std::size_t depth = 0;
            for (std::size_t j = 0; j < loops.size(); ++j)
                depth +=
                    j != i && contains(places(points, loops[j].corners), n, points[corner_apart(loops[i], loops[j])]);
            if (depth % 2 == 0) continue;
            const auto at = [&](std::size_t k) { return outline.begin() + static_cast<std::ptrdiff_t>(k); };
            std::reverse(at(loops[i].first + 1), at(loops[i].end));
            again = ++turned <= loops.size();  // reversing a loop also reverses the loops inside it
        }
    }
    return turned;
}

bool drop_crossing_corners(std::span<const Point> points, const Normal& n, double place, double tolerance,
                           std::vector<std::uint32_t>& outline, std::size_t& dropped) {
    const auto distance = [](const Point& p, const Point& a, const Point& b) {
        const Vec3 edge = b - a;
        const double along = std::clamp(dot(p - a, edge) / squared_norm(edge), 0.0, 1.0);
        return norm(p - (a + along * edge));
    };
    for (EdgePair crossing{}; outline.size() >= 3;) {
        const std::vector<Point> corners = places(points, outline);
        if (!crosses_itself(corners, n, place, crossing)) return true;
        const std::size_t m = corners.size();
        std::size_t nearest = 0;
        double least = HUGE_VAL;
        for (const auto& [edge, other] :
             {std::pair{crossing.first, crossing.second}, {crossing.second, crossing.first}})
            for (const std::size_t end : {edge, (edge + 1) % m})
                if (const double d = distance(corners[end], corners[other], corners[(other + 1) % m]); d < least)
                    least = d, nearest = end;
        if (least > tolerance) return false;
        outline.erase(outline.begin() + static_cast<std::ptrdiff_t>(nearest));
        ++dropped;
        drop_repeated_corners(outline);
    }
    return true;
}

bool is_one_polygon(std::span<const Point> points, std::span<const std::uint32_t> outline, const Vec3& area,
                    double tolerance) {
    if (!repeats_a_corner(outline)) return true;
    std::vector<BorderEdge> edges;
    for (std::size_t i = 0; i < outline.size(); ++i) edges.push_back({outline[i], outline[(i + 1) % outline.size()]});
    const auto loops = border_loops(points, std::move(edges), area, tolerance);
    if (loops.empty()) return false;
    const std::vector<Point> outer = places(points, loops[0]);
    for (std::size_t i = 1; i < loops.size(); ++i) {
        if (dot(area_vector(places(points, loops[i])), area) > 0) continue;  // another outer loop, not a hole
        for (std::uint32_t c : loops[i])
            if (std::find(loops[0].begin(), loops[0].end(), c) == loops[0].end() &&
                !contains(outer, normalized(area), points[c]))
                return false;
    }
    return true;
}

}  // namespace exitance
