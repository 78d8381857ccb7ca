#include "exitance/measure/floor_shapes.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/disjoint_sets.hpp"

namespace exitance {
namespace {

constexpr double upward = 0.999;  ///< Cosine between directions that count as equal; derived from slopes below 4%.

FloorShape shape_of(RegionId region, std::vector<std::vector<Point>> loops, const Plane& plane, double area) {
    FloorShape out{region, std::move(loops), plane, area, {}};
    for (const std::vector<Point>& loop : out.loops)
        for (const Point& p : loop) out.box.add(p);
    return out;
}

bool touch(const FloorShape& a, const FloorShape& b) {
    for (std::size_t k = 0; k < 3; ++k)
        if (a.box.lo[k] > b.box.hi[k] + one_plane || b.box.lo[k] > a.box.hi[k] + one_plane) return false;
    return dot(a.plane.n, b.plane.n) > upward && std::abs(a.plane.signed_distance(b.loops[0][0])) < one_plane;
}

/// Longest edge of a floor, projected on its plane.
Vec3 longest_edge(const Floor& floor) {
    constexpr double rounding = 1e-9;  // derived from double precision: equal edges differ by less
    Vec3 longest;
    for (const FloorShape& shape : floor.shapes)
        for (const std::vector<Point>& loop : shape.loops)
            for (std::size_t i = 0; i < loop.size(); ++i) {
                const Vec3 edge = loop[(i + 1) % loop.size()] - loop[i];
                if (norm(edge) > norm(longest) * (1 + rounding)) longest = edge;
            }
    const Normal n = floor.shapes[0].plane.n;
    return longest - dot(longest, n) * n;
}

}  // namespace

bool FloorShape::holds(const Point& p) const {
    if (p.x < box.lo.x - one_plane || p.x > box.hi.x + one_plane || p.y < box.lo.y - one_plane ||
        p.y > box.hi.y + one_plane)
        return false;
    bool inside = false;
    for (const std::vector<Point>& loop : loops) inside ^= contains(loop, plane.n, p);
    return inside;
}

std::size_t Floor::shape_at(const Point& p) const {
    const auto at = std::find_if(shapes.begin(), shapes.end(), [&](const FloorShape& shape) { return shape.holds(p); });
    return static_cast<std::size_t>(at - shapes.begin());
}

bool points_up(const Normal& n) {
    return n.z > upward;
}

FloorShape floor_shape(const Region& region, RegionId id) {
    return shape_of(id, region.loops, region.plane, region.area);
}

std::vector<FloorShape> shapes_of_group(const Scene& scene, const std::string& name) {
    const auto is_named = [&](SurfaceId s) { return scene.groups()[scene.surfaces()[s].group] == name; };
    std::vector<FloorShape> out;
    for (const RegionId id : scene.regions().ids()) {
        const Region& region = scene.regions()[id];
        if (std::all_of(region.surfaces.begin(), region.surfaces.end(), is_named)) {
            out.push_back(floor_shape(region, id));
            continue;
        }
        for (const SurfaceId s : region.surfaces)
            if (is_named(s))
                out.push_back(shape_of(id, {{scene.outline(s).begin(), scene.outline(s).end()}}, region.plane,
                                       scene.surfaces()[s].area));
    }
    const auto is_up = [](const FloorShape& shape) { return points_up(shape.plane.n); };
    if (std::any_of(out.begin(), out.end(), is_up)) std::erase_if(out, [&](const FloorShape& s) { return !is_up(s); });
    return out;
}

std::vector<Floor> join_shapes(std::vector<FloorShape> shapes) {
    // Sorted along x, so that only neighbours must be compared.
    std::stable_sort(shapes.begin(), shapes.end(),
                     [](const FloorShape& a, const FloorShape& b) { return a.box.lo.x < b.box.lo.x; });
    DisjointSets sets(shapes.size());
    for (std::size_t a = 0; a < shapes.size(); ++a)
        for (std::size_t b = a + 1; b < shapes.size(); ++b) {
            if (shapes[b].box.lo.x > shapes[a].box.hi.x + one_plane) break;
            if (touch(shapes[a], shapes[b])) sets.unite(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
        }
    std::vector<Floor> out;
    std::vector<std::size_t> number(shapes.size(), shapes.size());
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        std::size_t& at = number[sets.root(static_cast<std::uint32_t>(i))];
        if (at == shapes.size()) at = out.size(), out.emplace_back();
        out[at].area += shapes[i].area;
        out[at].shapes.push_back(std::move(shapes[i]));
    }
    std::stable_sort(out.begin(), out.end(), [](const Floor& a, const Floor& b) { return a.area > b.area; });
    return out;
}

MeasuringPlane rectangle_about(const Floor& floor) {
    const Normal n = floor.shapes[0].plane.n;
    const Vec3 along = normalized(longest_edge(floor)), across = cross(n, along);
    constexpr double rounding = 1e-9;  // derived from double precision
    constexpr double tie = 1e-3;       // derived from the angle below which a direction counts as parallel to an axis
    Vec3 u = along;
    for (const Vec3& way : {across, -1 * along, -1 * across})
        if (way.x + tie * way.y > u.x + tie * u.y + rounding) u = way;
    const Vec3 v = cross(n, u);
    const Point start = floor.shapes[0].loops[0][0];
    Vec2 low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};
    for (const FloorShape& shape : floor.shapes)
        for (const std::vector<Point>& loop : shape.loops)
            for (const Point& p : loop) {
                const double a = dot(p - start, u), b = dot(p - start, v);
                low = {std::min(low.x, a), std::min(low.y, b)}, high = {std::max(high.x, a), std::max(high.y, b)};
            }
    return {start + low.x * u + low.y * v, (high.x - low.x) * u, (high.y - low.y) * v};
}

}  // namespace exitance
