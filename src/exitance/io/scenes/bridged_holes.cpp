#include "exitance/io/scenes/bridged_holes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace exitance {
namespace {

using Flat = std::array<double, 2>;

/// Maps points to the plane of a polygon.
class Flattening {
  public:
    explicit Flattening(const std::vector<Point>& rim) : origin_(rim.front()), frame_(normalized(area_vector(rim))) {}
    Flat operator()(const Point& p) const { return {dot(p - origin_, frame_.u), dot(p - origin_, frame_.v)}; }

  private:
    Point origin_;
    Frame frame_;
};

/// Twice the signed area of a triangle.
double turn(const Flat& a, const Flat& b, const Flat& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool is_between(const Flat& p, const Flat& a, const Flat& b) {
    return std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) && std::min(a[1], b[1]) <= p[1] &&
           p[1] <= std::max(a[1], b[1]);
}

/// True if segments ab and cd meet at a point other than a common end.
bool meet(const Flat& a, const Flat& b, const Flat& c, const Flat& d) {
    const bool touches = a == c || a == d || b == c || b == d;
    const double abc = turn(a, b, c), abd = turn(a, b, d), cda = turn(c, d, a), cdb = turn(c, d, b);
    if (touches) {  // two edges with a common end meet elsewhere only if they overlap
        if (abc != 0 || abd != 0) return false;
        const Flat& common = a == c || a == d ? a : b;
        const Flat &other = common == a ? b : a, &end = common == c ? d : c;
        return is_between(other, common, end) || is_between(end, common, other);
    }
    if (((abc > 0) != (abd > 0)) && ((cda > 0) != (cdb > 0))) return true;
    return (abc == 0 && is_between(c, a, b)) || (abd == 0 && is_between(d, a, b)) ||
           (cda == 0 && is_between(a, c, d)) || (cdb == 0 && is_between(b, c, d));
}

bool crosses(const Flat& a, const Flat& b, const std::vector<Flat>& loop) {
    for (std::size_t k = 0; k < loop.size(); ++k)
        if (meet(a, b, loop[k], loop[(k + 1) % loop.size()])) return true;
    return false;
}

std::vector<Flat> flattened(const std::vector<Point>& loop, const Flattening& flat) {
    std::vector<Flat> out;
    for (const Point& p : loop) out.push_back(flat(p));
    return out;
}

/// Inserts a hole at its shortest bridge; returns false if every bridge crosses an edge.
bool join(std::vector<Point>& outline, const std::vector<Point>& hole, const std::vector<std::vector<Point>>& others,
          const Flattening& flat) {
    const std::vector<Flat> rim = flattened(outline, flat), inner = flattened(hole, flat);
    std::vector<std::vector<Flat>> loops;
    for (const std::vector<Point>& other : others) loops.push_back(flattened(other, flat));
    struct Bridge {
        double length;
        std::size_t from, to;
    };
    std::vector<Bridge> bridges;
    for (std::size_t i = 0; i < rim.size(); ++i)
        for (std::size_t j = 0; j < inner.size(); ++j)
            bridges.push_back({std::hypot(rim[i][0] - inner[j][0], rim[i][1] - inner[j][1]), i, j});
    std::sort(bridges.begin(), bridges.end(), [](const Bridge& a, const Bridge& b) {
        return std::tie(a.length, a.from, a.to) < std::tie(b.length, b.from, b.to);
    });
    for (const Bridge& bridge : bridges) {
        const Flat &a = rim[bridge.from], &b = inner[bridge.to];
        if (crosses(a, b, rim) || crosses(a, b, inner)) continue;
        if (std::any_of(loops.begin(), loops.end(), [&](const auto& loop) { return crosses(a, b, loop); })) continue;
        std::vector<Point> detour(hole.begin() + std::ptrdiff_t(bridge.to), hole.end());
        detour.insert(detour.end(), hole.begin(), hole.begin() + std::ptrdiff_t(bridge.to) + 1);
        detour.push_back(outline[bridge.from]);
        outline.insert(outline.begin() + std::ptrdiff_t(bridge.from) + 1, detour.begin(), detour.end());
        return true;
    }
    return false;
}

}  // namespace

std::vector<Point> bridge_holes(const std::vector<Point>& rim, const std::vector<std::vector<Point>>& holes) {
    std::vector<Point> outline = rim;
    const Vec3 area = area_vector(rim);
    if (!(norm(area) > 0)) return outline;
    const Flattening flat(rim);
    for (std::size_t k = 0; k < holes.size(); ++k) {
        std::vector<Point> hole = holes[k];
        if (hole.size() < 3) continue;
        if (dot(area_vector(hole), area) > 0) std::reverse(hole.begin(), hole.end());
        join(outline, hole, {holes.begin() + std::ptrdiff_t(k) + 1, holes.end()}, flat);
    }
    return outline;
}

}  // namespace exitance
