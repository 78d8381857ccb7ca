#include "exitance/measure/working_plane.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/measure/floor_rooms.hpp"

namespace exitance {
namespace {

constexpr double min_plane_share = 0.1;  ///< Share of the largest area of named faces; smaller planes are not used.
constexpr std::size_t max_planes = 32;

Error refuse(const std::string& message, const std::string& hint) {
    return {ErrorCode::usage, message, "--plane", hint};
}

/// Groups of named faces that are large enough for planes of their own.
std::vector<Floor> large_groups(std::vector<FloorShape> shapes) {
    std::vector<Floor> out = join_shapes(std::move(shapes));
    if (!out.empty()) {
        const double least = min_plane_share * out[0].area;
        std::erase_if(out, [&](const Floor& f) { return f.area < least; });
    }
    if (out.size() > max_planes) out.resize(max_planes);
    return out;
}

/// True if a point of the floor's plane is inside its outline, by at least the border. Tests places on a circle around
/// the point, so that edges between shapes do not count.
bool is_well_within(const Floor& floor, const Point& p, double border) {
    constexpr int places = 24;
    if (!floor.holds(p)) return false;
    const Frame frame(floor.shapes[0].plane.n);
    for (int i = 0; i < places && border > 0; ++i) {
        const double a = 2 * pi * i / places;
        if (!floor.holds(p + border * frame.to_world(std::cos(a), std::sin(a), 0))) return false;
    }
    return true;
}

std::string name_of(const PlaneRequest& request, const std::string& place) {
    const std::string name = request.height ? fmt::format("{:.4g} m above {}", *request.height, place) : place;
    return request.is_cylindrical ? name + ", cylindrical" : name;
}

/// Makes the grid over a rectangle. `holds(p, border)`: true if a point of the rectangle's plane counts.
template <class Holds>
Result<GridLight> make_plane(const PlaneRequest& request, MeasuringPlane plane, const Holds& holds) {
    plane.spacing = request.spacing;
    plane.margin = request.border.value_or(default_border(norm(plane.u), norm(plane.v), request.height.has_value()));
    const Vec3 rise = request.height.value_or(0) * normalized(cross(plane.u, plane.v));
    plane.origin += rise;
    Result<GridLight> grid = make_grid(plane);
    if (!grid) return refuse(grid.error().message, grid.error().hint);
    for (const Point& p : grid->points) grid->counts.push_back(holds(p - rise, plane.margin));
    if (std::none_of(grid->counts.begin(), grid->counts.end(), [](bool b) { return b; }))
        return refuse(fmt::format("a border of {:.3g} m leaves no point", plane.margin),
                      "choose a smaller one, border=B");
    grid->is_cylindrical = request.is_cylindrical;
    return grid;
}

Result<std::vector<GridLight>> planes_of_rooms(const FloorRooms& rooms, const PlaneRequest& request) {
    if (rooms.count() == 0) return refuse("the scene has no floor", "name the faces to measure on");
    std::vector<GridLight> out;
    for (std::size_t i = 0; i < rooms.count(); ++i) {
        Result<GridLight> grid = make_plane(request, rooms[i].rectangle,
                                            [&](const Point& p, double border) { return rooms.holds(i, p, border); });
        if (!grid && i > 0) continue;  // e.g. a closet beside a hall
        if (!grid) return grid.error();
        grid->room = i;
        grid->name = name_of(request, rooms.count() > 1 ? rooms.label(i) : "floor");
        out.push_back(std::move(*grid));
    }
    return out;
}

/// Distance from a point to a segment, metres.
double distance_to_edge(const Point& p, const Point& a, const Point& b) {
    const Vec3 edge = b - a;
    const double t = std::clamp(dot(p - a, edge) / squared_norm(edge), 0.0, 1.0);
    return norm(p - a - t * edge);
}

/// Distance from a point of the floor's plane to the floor, metres; 0 inside.
double distance_to_floor(const Floor& floor, const Point& p) {
    if (floor.holds(p)) return 0;
    double nearest = HUGE_VAL;
    for (const FloorShape& shape : floor.shapes)
        for (const std::vector<Point>& loop : shape.loops)
            for (std::size_t i = 0; i < loop.size(); ++i)
                nearest = std::min(nearest, distance_to_edge(p, loop[i], loop[(i + 1) % loop.size()]));
    return nearest;
}

/// Makes the grid of a band around a task area, inside the same room: of the points that are more than `from` and at
/// most `to` metres away from it.
Result<GridLight> make_band(const PlaneRequest& request, const Floor& floor, const FloorRooms& rooms,
                            const std::optional<std::size_t>& room, double from, double to) {
    MeasuringPlane plane = rectangle_about(floor);
    const Vec3 u = normalized(plane.u), v = normalized(plane.v), n = cross(u, v);
    plane.origin = plane.origin - to * (u + v);
    plane.u = plane.u + 2 * to * u, plane.v = plane.v + 2 * to * v;
    PlaneRequest band = request;
    band.border = 0;
    return make_plane(band, plane, [&](const Point& p, double) {
        const double distance = distance_to_floor(floor, p);
        return distance > from && distance <= to && (!room || rooms.at(p + request.height.value_or(0) * n) == *room);
    });
}

/// Adds the requested bands around a task area, whose grid is the last one.
Result<void> add_bands(const PlaneRequest& request, const Floor& floor, const FloorRooms& rooms,
                       std::vector<GridLight>& out) {
    const GridLight task = out.back();
    const double inner = request.surroundings.value_or(0);
    const auto add = [&](PlaneZone zone, double from, double to) -> Result<void> {
        Result<GridLight> band = make_band(request, floor, rooms, task.room, from, to);
        if (!band) return band.error();
        band->name = fmt::format("{}, {}", task.name, name_of(zone)), band->room = task.room, band->zone = zone;
        out.push_back(std::move(*band));
        return {};
    };
    if (request.surroundings)
        if (const Result<void> added = add(PlaneZone::surroundings, 0, inner); !added) return added;
    if (request.background) return add(PlaneZone::background, inner, inner + *request.background);
    return {};
}

Result<std::vector<GridLight>> planes_of_group(const Scene& scene, const FloorRooms& rooms,
                                               const PlaneRequest& request) {
    std::vector<FloorShape> named = shapes_of_group(scene, request.group);
    if (named.empty()) {
        std::string names;
        for (const GroupId g : scene.groups().ids())
            if (g.value < 20) names += fmt::format("{}{}", names.empty() ? "" : ", ", scene.groups()[g]);
        return refuse(fmt::format("no faces are called '{}'", request.group), "there are " + names);
    }
    const std::vector<Floor> all = large_groups(std::move(named));
    std::vector<GridLight> out;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Floor& floor = all[i];
        Result<GridLight> grid = make_plane(request, rectangle_about(floor), [&](const Point& p, double border) {
            return is_well_within(floor, p, border);
        });
        if (!grid && i > 0) continue;
        if (!grid) return grid.error();
        grid->name = name_of(request, all.size() > 1 ? fmt::format("{} {}", request.group, i + 1) : request.group);
        const std::size_t room = rooms.at(grid->plane.origin + 0.5 * (grid->plane.u + grid->plane.v));
        if (room < rooms.count()) grid->room = room;
        out.push_back(std::move(*grid));
        if (const Result<void> added = add_bands(request, floor, rooms, out); !added) return added.error();
    }
    return out;
}

}  // namespace

double default_border(double length, double width, bool is_above) {
    constexpr double border = 0.5, share = 0.15, max_share = 0.25;
    const double shorter = std::min(length, width);
    return !is_above ? 0 : border > max_share * shorter ? share * shorter : border;
}

Result<std::vector<GridLight>> make_working_planes(const Scene& scene, const FloorRooms& rooms,
                                                   const PlaneRequest& request) {
    return request.group.empty() ? planes_of_rooms(rooms, request) : planes_of_group(scene, rooms, request);
}

}  // namespace exitance
