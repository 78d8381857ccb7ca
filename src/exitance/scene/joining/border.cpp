#include "exitance/scene/joining/border.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

using Loop = std::vector<std::uint32_t>;

bool before(const Point& a, const Point& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// Removes pairs of opposite edges. Returns false if an edge remains twice.
bool cancel_opposites(std::vector<BorderEdge>& edges) {
    const auto key = [](const BorderEdge& e) { return std::minmax(e.from, e.to); };
    std::sort(edges.begin(), edges.end(), [&](const BorderEdge& a, const BorderEdge& b) {
        return key(a) != key(b) ? key(a) < key(b) : a.from < b.from;
    });
    std::vector<BorderEdge> left;
    for (std::size_t i = 0, j; i < edges.size(); i = j) {
        for (j = i; j < edges.size() && key(edges[j]) == key(edges[i]);) ++j;
        const auto forward =
            std::count_if(&edges[i], &edges[i] + (j - i), [](const BorderEdge& e) { return e.from < e.to; });
        const auto surplus = 2 * forward - static_cast<std::ptrdiff_t>(j - i);
        if (surplus > 1 || surplus < -1) return false;
        if (surplus != 0) left.push_back(surplus > 0 ? edges[i] : edges[j - 1]);
    }
    edges = std::move(left);
    return true;
}

/// Clockwise angle from the reversed arriving edge to `leaving`, in (0, 2 pi]: the interior angle.
double inside_angle(const Vec3& arriving, const Vec3& leaving, const Normal& n) {
    const Vec3 back = -arriving;
    const double angle = std::atan2(dot(n, cross(leaving, back)), dot(leaving, back));
    return angle > 0 ? angle : angle + 2 * pi;
}

/// Removes corners at which the border is straight, seen along n, and spikes due to rounding.
void drop_straight_corners(std::span<const Point> points, Loop& loop, const Normal& n, double tolerance) {
    Loop out;
    const auto straight = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const Vec3 chord = points[c] - points[a], side = points[b] - points[a];
        const double length = norm(chord);
        if (length <= tolerance) return true;
        return std::abs(dot(n, cross(chord, side))) <= tolerance * length && dot(side, points[c] - points[b]) >= 0;
    };
    for (std::uint32_t p : loop) {
        while (out.size() >= 2 && straight(out[out.size() - 2], out.back(), p)) out.pop_back();
        if (out.empty() || out.back() != p) out.push_back(p);
    }
    while (out.size() >= 3) {  // also merge across the end of the loop
        if (straight(out[out.size() - 2], out.back(), out.front()))
            out.pop_back();
        else if (straight(out.back(), out.front(), out[1]))
            out.erase(out.begin());
        else
            break;
    }
    loop = std::move(out);
}

Vec3 loop_area(std::span<const Point> points, const Loop& loop) {
    Vec3 sum;
    for (std::size_t i = 2; i < loop.size(); ++i)
        sum += cross(points[loop[i - 1]] - points[loop[0]], points[loop[i]] - points[loop[0]]);
    return 0.5 * sum;
}

// Follows edges to closed loops; empty if some do not close. At each point the edge with the smallest interior angle
// continues.
std::vector<Loop> walk(std::span<const Point> points, std::vector<BorderEdge>& edges, const Normal& n) {
    std::sort(edges.begin(), edges.end(), [](const BorderEdge& a, const BorderEdge& b) {
        return a.from != b.from ? a.from < b.from : a.to < b.to;
    });
    std::vector<char> used(edges.size(), 0);
    const auto leaving = [&](std::uint32_t p) {
        return std::lower_bound(edges.begin(), edges.end(), p,
                                [](const BorderEdge& e, std::uint32_t v) { return e.from < v; }) -
               edges.begin();
    };
    std::vector<Loop> loops;
    for (std::size_t start = 0; start < edges.size(); ++start) {
        if (used[start]) continue;
        Loop loop;
        std::size_t e = start;
        while (!used[e]) {
            used[e] = 1;
            loop.push_back(edges[e].from);
            const Vec3 arriving = points[edges[e].to] - points[edges[e].from];
            std::size_t next = edges.size();
            double smallest = 0;
            for (auto o = static_cast<std::size_t>(leaving(edges[e].to));
                 o < edges.size() && edges[o].from == edges[e].to; ++o) {
                const double angle = inside_angle(arriving, points[edges[o].to] - points[edges[o].from], n);
                if (next == edges.size() || angle < smallest) next = o, smallest = angle;
            }
            if (next == edges.size()) return {};
            e = next;
        }
        // A loop that does not return to its start has met another loop: the edges are not a border.
        if (e != start) return {};
        loops.push_back(std::move(loop));
    }
    return loops;
}

}  // namespace

void start_at_smallest(std::span<const Point> points, Loop& loop) {
    std::rotate(
        loop.begin(),
        std::min_element(loop.begin(), loop.end(), [&](auto a, auto b) { return before(points[a], points[b]); }),
        loop.end());
}

std::vector<Loop> border_loops(std::span<const Point> points, std::vector<BorderEdge> edges, const Vec3& area_vector,
                               double tolerance) {
    if (!cancel_opposites(edges)) return {};
    const double area = norm(area_vector);
    const Normal n = area_vector / area;
    std::vector<Loop> loops = walk(points, edges, n);
    double sum = 0, round = 0;
    for (Loop& loop : loops) {
        drop_straight_corners(points, loop, n, tolerance);
        sum += dot(n, loop_area(points, loop));
        for (std::size_t i = 0; i < loop.size(); ++i)
            round += norm(points[loop[i]] - points[loop[(i + 1) % loop.size()]]);
    }
    std::erase_if(loops, [](const Loop& loop) { return loop.size() < 3; });
    if (loops.empty() || std::abs(sum - area) > 1e-9 * area + tolerance * round) return {};
    for (Loop& loop : loops) start_at_smallest(points, loop);
    std::sort(loops.begin(), loops.end(), [&](const Loop& a, const Loop& b) {
        const bool hole_a = dot(n, loop_area(points, a)) < 0, hole_b = dot(n, loop_area(points, b)) < 0;
        if (hole_a != hole_b) return hole_b;
        if (a[0] != b[0]) return before(points[a[0]], points[b[0]]);
        return before(points[a[1]], points[b[1]]);
    });
    return loops;
}

std::vector<Loop> lone_face_loops(const FaceMesh& mesh, std::uint32_t face, double tolerance) {
    const auto outline = mesh.outline(face);
    std::vector<BorderEdge> edges;
    for (std::size_t i = 0; i < outline.size(); ++i) edges.push_back({outline[i], outline[(i + 1) % outline.size()]});
    std::vector<Loop> loops = border_loops(mesh.points, std::move(edges), mesh.area_vector[face], tolerance);
    if (loops.empty()) loops.push_back(Loop(outline.begin(), outline.end()));
    return loops;
}

}  // namespace exitance
