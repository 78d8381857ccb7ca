#include "exitance/measure/working_plane.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace exitance {
namespace {

constexpr double level_tolerance = 1e-3;  ///< Distance below which faces are in one plane, metres.
constexpr double upward = 0.999;          ///< Cosine to the vertical for faces that point up.
constexpr double least_share = 0.1;       ///< Share of the largest area; smaller planes are not used.
constexpr std::size_t most_planes = 32;

/// A polygon with holes: a region or one face.
struct Shape {
    std::vector<std::vector<Point>> loops;
    Plane plane;
    double area = 0;  ///< m^2
    Box box;

    bool holds(const Point& p) const {
        bool inside = false;
        for (const std::vector<Point>& loop : loops) inside ^= contains(loop, plane.n, p);
        return inside;
    }
};

/// Coplanar shapes that touch each other.
struct Floor {
    std::vector<Shape> shapes;
    double area = 0;  ///< m^2
};

Error refuse(const std::string& message, const std::string& hint) {
    return {ErrorCode::usage, message, "--plane", hint};
}

Shape shape_of(std::vector<std::vector<Point>> loops, const Plane& plane, double area) {
    Shape out{std::move(loops), plane, area, {}};
    for (const std::vector<Point>& loop : out.loops)
        for (const Point& p : loop) out.box.add(p);
    return out;
}

Shape shape_of(const Region& region) {
    return shape_of(region.loops, region.plane, region.area);
}

std::vector<Shape> floors(const Scene& scene) {
    double largest = 0, lowest = std::numeric_limits<double>::infinity();
    for (const Region& region : scene.regions())
        if (region.plane.n.z > upward) largest = std::max(largest, region.area);
    for (const Region& region : scene.regions())
        if (region.plane.n.z > upward && region.area >= least_share * largest)
            lowest = std::min(lowest, region.loops[0][0].z);
    std::vector<Shape> out;
    for (const Region& region : scene.regions())
        if (region.plane.n.z > upward && std::abs(region.loops[0][0].z - lowest) < level_tolerance)
            out.push_back(shape_of(region));
    return out;
}

/// Faces of a group: whole regions if all of their faces are in it, else single faces.
std::vector<Shape> shapes_of_group(const Scene& scene, const std::string& name) {
    const auto is_named = [&](SurfaceId s) { return scene.groups()[scene.surfaces()[s].group] == name; };
    std::vector<Shape> out;
    for (const Region& region : scene.regions()) {
        if (std::all_of(region.surfaces.begin(), region.surfaces.end(), is_named)) {
            out.push_back(shape_of(region));
            continue;
        }
        for (const SurfaceId s : region.surfaces)
            if (is_named(s))
                out.push_back(shape_of({{scene.outline(s).begin(), scene.outline(s).end()}}, region.plane,
                                       scene.surfaces()[s].area));
    }
    const auto is_up = [](const Shape& shape) { return shape.plane.n.z > upward; };
    if (std::any_of(out.begin(), out.end(), is_up)) std::erase_if(out, [&](const Shape& s) { return !is_up(s); });
    return out;
}

bool touch(const Shape& a, const Shape& b) {
    for (std::size_t k = 0; k < 3; ++k)
        if (a.box.lo[k] > b.box.hi[k] + level_tolerance || b.box.lo[k] > a.box.hi[k] + level_tolerance) return false;
    return dot(a.plane.n, b.plane.n) > upward && std::abs(a.plane.signed_distance(b.loops[0][0])) < level_tolerance;
}

/// Groups shapes that are in one plane and touch each other directly or indirectly; the largest group first.
std::vector<Floor> join(std::vector<Shape> shapes) {
    // Sorted along x, so that only neighbours must be compared.
    std::stable_sort(shapes.begin(), shapes.end(),
                     [](const Shape& a, const Shape& b) { return a.box.lo.x < b.box.lo.x; });
    std::vector<std::size_t> root(shapes.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto find = [&](std::size_t i) {
        while (root[i] != i) i = root[i] = root[root[i]];
        return i;
    };
    for (std::size_t a = 0; a < shapes.size(); ++a)
        for (std::size_t b = a + 1; b < shapes.size(); ++b) {
            if (shapes[b].box.lo.x > shapes[a].box.hi.x + level_tolerance) break;
            if (touch(shapes[a], shapes[b])) root[find(a)] = find(b);
        }
    std::vector<Floor> out;
    std::vector<std::size_t> number(shapes.size(), shapes.size());
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        std::size_t& at = number[find(i)];
        if (at == shapes.size()) at = out.size(), out.emplace_back();
        out[at].area += shapes[i].area;
        out[at].shapes.push_back(std::move(shapes[i]));
    }
    std::stable_sort(out.begin(), out.end(), [](const Floor& a, const Floor& b) { return a.area > b.area; });
    if (!out.empty()) {
        const double least = least_share * out[0].area;
        std::erase_if(out, [&](const Floor& f) { return f.area < least; });
    }
    if (out.size() > most_planes) out.resize(most_planes);
    return out;
}

/// Bounding rectangle of a floor, aligned with its longest edge. Its u axis is the one of the four side directions that
/// is closest to +x.
MeasuringPlane rectangle_about(const Floor& floor) {
    Vec3 longest;
    for (const Shape& shape : floor.shapes)
        for (const std::vector<Point>& loop : shape.loops)
            for (std::size_t i = 0; i < loop.size(); ++i) {
                const Vec3 edge = loop[(i + 1) % loop.size()] - loop[i];
                if (norm(edge) > norm(longest) * (1 + 1e-9)) longest = edge;
            }
    const Normal n = floor.shapes[0].plane.n;
    const Vec3 along = normalized(longest - dot(longest, n) * n), across = cross(n, along);
    Vec3 u = along;
    for (const Vec3& way : {across, -1 * along, -1 * across})
        if (way.x + 1e-3 * way.y > u.x + 1e-3 * u.y + 1e-9) u = way;
    const Vec3 v = cross(n, u);
    const Point start = floor.shapes[0].loops[0][0];
    Vec2 low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};
    for (const Shape& shape : floor.shapes)
        for (const std::vector<Point>& loop : shape.loops)
            for (const Point& p : loop) {
                const double a = dot(p - start, u), b = dot(p - start, v);
                low = {std::min(low.x, a), std::min(low.y, b)}, high = {std::max(high.x, a), std::max(high.y, b)};
            }
    return {start + low.x * u + low.y * v, (high.x - low.x) * u, (high.y - low.y) * v};
}

bool is_within(const Floor& floor, const Point& p) {
    return std::any_of(floor.shapes.begin(), floor.shapes.end(), [&](const Shape& shape) { return shape.holds(p); });
}

/// True if a point of the floor's plane is inside its outline, by at least the border. Tests places on a circle around
/// the point, so that edges between shapes do not count.
bool is_well_within(const Floor& floor, const Point& p, double border) {
    constexpr int places = 24;
    if (!is_within(floor, p)) return false;
    const Frame frame(floor.shapes[0].plane.n);
    for (int i = 0; i < places && border > 0; ++i) {
        const double a = 2 * pi * i / places;
        if (!is_within(floor, p + border * frame.to_world(std::cos(a), std::sin(a), 0))) return false;
    }
    return true;
}

std::string name_of(const PlaneRequest& request, std::size_t number, std::size_t count) {
    std::string name = request.group.empty() ? "floor" : request.group;
    if (count > 1) name += fmt::format(" {}", number + 1);
    if (request.height) name = fmt::format("{:.4g} m above {}", *request.height, name);
    return request.is_cylindrical ? name + ", cylindrical" : name;
}

Result<GridLight> make_plane(const PlaneRequest& request, const Floor& floor) {
    MeasuringPlane plane = rectangle_about(floor);
    plane.spacing = request.spacing;
    plane.margin = request.border.value_or(default_border(norm(plane.u), norm(plane.v), request.height.has_value()));
    const Vec3 rise = request.height.value_or(0) * floor.shapes[0].plane.n;
    plane.origin += rise;
    Result<GridLight> grid = make_grid(plane);
    if (!grid) return refuse(grid.error().message, grid.error().hint);
    for (const Point& p : grid->points) grid->counts.push_back(is_well_within(floor, p - rise, plane.margin));
    if (std::none_of(grid->counts.begin(), grid->counts.end(), [](bool b) { return b; }))
        return refuse(fmt::format("a border of {:.3g} m leaves no point", plane.margin),
                      "choose a smaller one, border=B");
    grid->is_cylindrical = request.is_cylindrical;
    return grid;
}

}  // namespace

double default_border(double length, double width, bool is_above) {
    constexpr double border = 0.5, share = 0.15, most = 0.25;
    const double shorter = std::min(length, width);
    return !is_above ? 0 : border > most * shorter ? share * shorter : border;
}

Result<std::vector<GridLight>> make_working_planes(const Scene& scene, const PlaneRequest& request) {
    std::vector<Shape> named = request.group.empty() ? floors(scene) : shapes_of_group(scene, request.group);
    if (named.empty() && request.group.empty()) return refuse("the scene has no floor", "name the faces to measure on");
    if (named.empty()) {
        std::string names;
        for (const GroupId g : scene.groups().ids())
            if (g.value < 20) names += fmt::format("{}{}", names.empty() ? "" : ", ", scene.groups()[g]);
        return refuse(fmt::format("no faces are called '{}'", request.group), "there are " + names);
    }
    const std::vector<Floor> all = join(std::move(named));
    std::vector<GridLight> out;
    for (std::size_t i = 0; i < all.size(); ++i) {
        Result<GridLight> grid = make_plane(request, all[i]);
        if (!grid && all.size() > 1 && i > 0) continue;  // e.g. a closet beside a hall
        if (!grid) return grid.error();
        grid->name = name_of(request, i, all.size());
        out.push_back(std::move(*grid));
    }
    return out;
}

}  // namespace exitance
