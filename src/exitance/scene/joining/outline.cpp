#include "exitance/scene/joining/outline.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

/// An edge in the plane's coordinates.
struct FlatEdge {
    Vec2 p, q;
    double lo, hi;  ///< Extent of an edge along x.
    std::size_t number;
};

/// Side of the line p -> q on which r lies: -1, 1, or 0 within the tolerance.
int side(const Vec2& p, const Vec2& q, const Vec2& r, double tolerance) {
    const Vec2 d = q - p;
    const double distance = cross(d, r - p), limit = tolerance * std::hypot(d.x, d.y);
    return distance > limit ? 1 : distance < -limit ? -1 : 0;
}

bool cross_properly(const FlatEdge& e, const FlatEdge& f, double tolerance) {
    if (std::max(e.p.y, e.q.y) < std::min(f.p.y, f.q.y) || std::max(f.p.y, f.q.y) < std::min(e.p.y, e.q.y))
        return false;
    return side(e.p, e.q, f.p, tolerance) * side(e.p, e.q, f.q, tolerance) < 0 &&
           side(f.p, f.q, e.p, tolerance) * side(f.p, f.q, e.q, tolerance) < 0;
}

}  // namespace

std::size_t drop_repeated_corners(std::vector<std::uint32_t>& outline) {
    const std::size_t before = outline.size();
    std::vector<std::uint32_t> out;
    for (std::uint32_t p : outline) {
        if (!out.empty() && out.back() == p) continue;
        if (out.size() >= 2 && out[out.size() - 2] == p)
            out.pop_back();
        else
            out.push_back(p);
    }
    while (out.size() >= 2) {  // also merge across the end of the outline
        const bool spike = out.size() >= 3 && out[out.size() - 2] == out.front();
        if (out.back() == out.front() || spike)
            out.pop_back();
        else if (out.size() >= 3 && out.back() == out[1])
            out.erase(out.begin());
        else
            break;
    }
    outline = std::move(out);
    return before - outline.size();
}

bool is_collinear(std::span<const Point> outline, double tolerance) {
    Vec3 d;
    for (const Point& p : outline)
        if (squared_norm(p - outline[0]) > squared_norm(d)) d = p - outline[0];
    const double length = norm(d);
    return std::all_of(outline.begin(), outline.end(),
                       [&](const Point& p) { return norm(cross(d, p - outline[0])) <= tolerance * length; });
}

double out_of_plane(std::span<const Point> outline, const Normal& n) {
    double mean = 0, farthest = 0;
    for (const Point& p : outline) mean += dot(n, p - outline[0]) / static_cast<double>(outline.size());
    for (const Point& p : outline) farthest = std::max(farthest, std::abs(dot(n, p - outline[0]) - mean));
    return farthest;
}

bool crosses_itself(std::span<const Point> outline, const Normal& n, double tolerance, EdgePair& where) {
    if (outline.size() < 4 || is_convex(outline, n)) return false;
    const Frame frame(n);
    const auto flat = [&](const Point& p) { return Vec2{dot(p - outline[0], frame.u), dot(p - outline[0], frame.v)}; };
    std::vector<FlatEdge> edges;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vec2 p = flat(outline[i]), q = flat(outline[(i + 1) % outline.size()]);
        edges.push_back({p, q, std::min(p.x, q.x), std::max(p.x, q.x), i});
    }
    std::sort(edges.begin(), edges.end(), [](const FlatEdge& a, const FlatEdge& b) { return a.lo < b.lo; });
    for (std::size_t i = 0; i < edges.size(); ++i)
        for (std::size_t j = i + 1; j < edges.size() && edges[j].lo <= edges[i].hi; ++j)
            if (cross_properly(edges[i], edges[j], tolerance)) {
                where = {std::min(edges[i].number, edges[j].number), std::max(edges[i].number, edges[j].number)};
                return true;
            }
    return false;
}

}  // namespace exitance
