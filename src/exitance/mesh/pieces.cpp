#include "exitance/mesh/pieces.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "exitance/base/parallel.hpp"
#include "exitance/mesh/planar_subdivision.hpp"
#include "exitance/mesh/rectangles.hpp"

namespace exitance {
namespace {

/// Lengths below this share of the polygon's extent are rounding errors. Derived from double precision.
constexpr double same_place = 1e-9;
/// Maximum deviation of corners from a parallelogram, as a share of its shortest side. Derived from files with six
/// digits, whose sides may be a hundredth of the scene's size.
constexpr double max_parallelogram_gap = 1e-4;
/// Minimum ratio of height to longest side of a triangle that is split off next to a parallelogram. Chosen: half of
/// it and twice it give the same light, measured by `exitance solve stair.obj --error 0.02`.
constexpr double sliver = 0.15;
/// Outlines with more corners are not searched for parallelograms at their border, which takes O(corners^3).
constexpr std::size_t max_peeled_corners = 40;

using Loop = std::vector<Point>;

Patch triangle(const Point& p, const Point& q, const Point& r) {
    return {p, q - p, r - p, Patch::Shape::triangle};
}

/// Returns four corners as a parallelogram if they deviate from one by at most a small share of the shortest side:
/// files with six digits have such rounding errors. Patches only carry functions; visibility uses the outlines. The
/// area is exactly that of the corners: a and b are means of opposite sides, and a x b is half the product of the
/// diagonals, as for the corners.
std::optional<Patch> as_parallelogram(std::span<const Point> p) {
    const Vec3 gap = (p[0] + p[2]) - (p[1] + p[3]);
    double shortest = norm(p[3] - p[0]);
    for (std::size_t i = 0; i < 3; ++i) shortest = std::min(shortest, norm(p[i + 1] - p[i]));
    if (norm(gap) > max_parallelogram_gap * shortest) return std::nullopt;
    const Vec3 a = 0.5 * ((p[1] - p[0]) + (p[2] - p[3])), b = 0.5 * ((p[3] - p[0]) + (p[2] - p[1]));
    return Patch{p[0] - gap / 4, a, b, Patch::Shape::parallelogram};
}

/// Returns a convex quadrilateral with two parallel sides as a parallelogram on the shorter one and a triangle; empty
/// if no sides are parallel or the triangle would be a sliver.
std::vector<Patch> as_trapezoid(std::span<const Point> p, double tolerance) {
    for (std::size_t i = 0; i < 4; ++i) {
        const Point &s = p[i], &t = p[(i + 1) % 4], &u = p[(i + 2) % 4],
                    &v = p[(i + 3) % 4];  // s -> t must be the longer of the two parallel sides
        const Vec3 lower = t - s, upper = u - v;
        const double length = norm(lower);
        if (norm(upper) > length || norm(cross(lower, upper)) > tolerance * length || dot(lower, upper) <= 0) continue;
        const Point foot = s + upper;  // parallelogram s, foot, u, v and triangle foot, t, u
        const Patch rest = triangle(foot, t, u);
        const double longest = std::max({norm(t - foot), norm(u - t), norm(u - foot)});
        if (2 * rest.area() < sliver * longest * longest) continue;
        return {Patch{s, upper, v - s, Patch::Shape::parallelogram}, rest};
    }
    return {};
}

/// Cuts a parallelogram off an outline. Its sides are three consecutive edges and a chord that nothing crosses. The
/// remaining outline has two corners less; corners at which it is straight are removed. Returns false if there is no
/// such parallelogram.
bool peel_parallelogram(Loop& loop, const Normal& n, double tolerance, std::vector<Patch>& out) {
    const std::size_t m = loop.size();
    for (std::size_t i = 0; m > 4 && i < m; ++i) {
        const Point quad[4] = {loop[i], loop[(i + 1) % m], loop[(i + 2) % m], loop[(i + 3) % m]};
        const auto patch = as_parallelogram(quad);
        if (!patch || dot(cross(patch->a, patch->b), n) <= 0) continue;
        bool free = true;
        for (std::size_t k = 4; k < m && free; ++k) {
            const Vec2 uv = patch->coordinates(loop[(i + k) % m]);
            free = uv.x < 0 || uv.x > 1 || uv.y < 0 || uv.y > 1;
        }
        if (!free) continue;
        out.push_back(*patch);
        std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>((i + 1) % m), loop.end());
        loop.erase(loop.begin(), loop.begin() + 2);
        for (std::size_t k = 0; loop.size() > 3 && k < loop.size();) {
            const Point &before = loop[(k + loop.size() - 1) % loop.size()], &after = loop[(k + 1) % loop.size()];
            const bool straight = norm(cross(after - before, loop[k] - before)) <= tolerance * norm(after - before);
            if (straight)
                loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(k));
            else
                ++k;
        }
        return true;
    }
    return false;
}

/// A frame in the polygon's plane along its longest edge, so that right angles are parallel to the axes.
struct LongestEdgeFrame {
    Point origin;
    Vec3 u, v;

    LongestEdgeFrame(std::span<const Loop> loops, const Normal& n) : origin(loops[0][0]) {
        double longest = -1;
        for (const Loop& loop : loops)
            for (std::size_t i = 0; i < loop.size(); ++i) {
                const Vec3 d = loop[(i + 1) % loop.size()] - loop[i];
                // The margin makes the first of several nearly equal edges win, independent of rounding.
                if (squared_norm(d) > longest * (1 + same_place)) longest = squared_norm(d), u = d;
            }
        u = normalized(u - dot(u, n) * n);
        v = cross(n, u);
    }
    Vec2 flat(const Point& p) const { return {dot(p - origin, u), dot(p - origin, v)}; }
    Point lifted(Vec2 p) const { return origin + p.x * u + p.y * v; }
};

/// Triangulates; pairs of triangles that form a parallelogram are joined.
std::vector<Patch> triangles(std::span<const Loop> loops, std::span<const std::vector<Vec2>> flat) {
    std::vector<Point> corners;
    for (const Loop& loop : loops) corners.insert(corners.end(), loop.begin(), loop.end());
    const auto all = delaunay_triangles(flat);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::size_t, std::size_t>>
        across;  // for each edge: the triangle and the side that have it
    std::vector<char> joined(all.size(), 0);
    std::vector<Patch> out;
    for (std::size_t t = 0; t < all.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t p = all[t][i], q = all[t][(i + 1) % 3], apex = all[t][(i + 2) % 3];
            across[{p, q}] = {t, i};
            const auto other = across.find({q, p});
            if (other == across.end() || joined[t] || joined[other->second.first]) continue;
            const auto [o, side] = other->second;
            const Point quad[4] = {corners[apex], corners[p], corners[all[o][(side + 2) % 3]], corners[q]};
            if (const auto patch = as_parallelogram(quad)) {
                joined[t] = joined[o] = 1;
                out.push_back(*patch);
            }
        }
    for (std::size_t t = 0; t < all.size(); ++t)
        if (!joined[t]) out.push_back(triangle(corners[all[t][0]], corners[all[t][1]], corners[all[t][2]]));
    return out;
}

}  // namespace

std::vector<Patch> tile(std::span<const Loop> loops, const Normal& n) {
    Box box;
    for (const Loop& loop : loops)
        for (const Point& p : loop) box.add(p);
    const double tolerance = same_place * box.diagonal();
    if (loops.size() == 1 && loops[0].size() == 3) return {triangle(loops[0][0], loops[0][1], loops[0][2])};
    if (loops.size() == 1 && loops[0].size() == 4) {
        if (const auto patch = as_parallelogram(loops[0])) return {*patch};
        if (is_convex(loops[0], n))
            if (auto two = as_trapezoid(loops[0], tolerance); !two.empty()) return two;
    }
    const LongestEdgeFrame frame(loops, n);
    std::vector<std::vector<Vec2>> flat;
    for (const Loop& loop : loops) {
        flat.emplace_back();
        for (const Point& p : loop) flat.back().push_back(frame.flat(p));
    }
    std::vector<Patch> out;
    for (const auto& [lo, hi] : tile_by_rectangles(flat, tolerance))
        out.push_back(
            {frame.lifted(lo), (hi.x - lo.x) * frame.u, (hi.y - lo.y) * frame.v, Patch::Shape::parallelogram});
    if (!out.empty()) return out;
    if (Loop rest = loops[0];
        loops.size() == 1 && rest.size() <= max_peeled_corners && peel_parallelogram(rest, n, tolerance, out)) {
        const auto others = tile(std::vector<Loop>{std::move(rest)}, n);
        out.insert(out.end(), others.begin(), others.end());
        return out;
    }
    return triangles(loops, flat);
}

std::vector<Piece> cut_into_pieces(const Scene& scene) {
    const auto& regions = scene.regions();
    std::vector<std::vector<Patch>> patches(regions.size());
    parallel_for(regions.size(), 256, [&](std::size_t i) {
        const Region& region = regions[RegionId(i)];
        patches[i] = tile(region.loops, region.plane.n);
    });
    std::vector<Piece> out;
    for (std::size_t i = 0; i < patches.size(); ++i)
        for (const Patch& patch : patches[i]) out.push_back({RegionId(i), patch});
    return out;
}

}  // namespace exitance
