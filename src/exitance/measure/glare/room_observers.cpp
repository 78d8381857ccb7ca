#include "exitance/measure/glare/room_observers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/transport/open_points.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

/// True if nothing is within the clearance of an eye, in ten directions, and the eye is not inside a body.
bool is_free(const Stage& stage, const Point& eye) {
    constexpr int around = 8;
    std::vector<Vec3> ways;
    for (int i = 0; i < around; ++i) {
        const double a = 2 * pi * i / around;
        ways.push_back({std::cos(a), std::sin(a), 0});
    }
    for (const double way : {1.0, -1.0}) ways.push_back({0, 0, way});
    std::vector<RayHit> hits(ways.size());
    stage.tracer.nearest(ways, eye, RegionId(), hits);
    if (std::any_of(hits.begin(), hits.end(), [](const RayHit& h) { return h.distance < observer_clearance; }))
        return false;
    return is_in_open(stage, eye, {0, 0, 1}, RegionId());
}

/// Names a horizontal line of sight: "looking +x", or by its angle from +x towards +y, "looking 30°".
std::string words_of_view(const Vec3& view) {
    constexpr double parallel = 0.999;  // cosine of an angle that counts as parallel; derived from 2.5 degrees
    for (const auto& [axis, name] : {std::pair(Vec3{1, 0, 0}, 'x'), std::pair(Vec3{0, 1, 0}, 'y')})
        if (std::abs(dot(view, axis)) > parallel)
            return fmt::format("looking {}{}", dot(view, axis) > 0 ? '+' : '-', name);
    return fmt::format("looking {:.0f}°", std::atan2(view.y, view.x) / degree);
}

/// A side of a room: the middle of the wall, the direction along it, and the direction across the room.
struct Side {
    Point middle;
    Vec3 along, across;
};

/// The free place of a side that is nearest to the middle of its wall, on a lattice of 0.1 m; none if there is none.
std::optional<Point> place_at(const Stage& stage, const FloorRooms& rooms, std::size_t room, const Side& side) {
    constexpr double spacing = 0.1, from_wall = 0.3;  // metres; derived from observer_clearance
    const double eye_height = std::min(seated_eye_height, 0.5 * rooms[room].height);
    const auto deep = static_cast<int>(0.5 * norm(side.across) / spacing);
    const auto wide = static_cast<int>(0.5 * norm(side.along) / spacing);
    struct Place {
        double distance;
        int right, in;
    };
    std::vector<Place> places;
    for (int in = 0; in <= deep; ++in)
        for (int right = -wide; right <= wide; ++right)
            places.push_back({std::hypot(from_wall + spacing * in, spacing * right), right, in});
    std::stable_sort(places.begin(), places.end(),
                     [](const Place& a, const Place& b) { return a.distance < b.distance; });
    const Vec3 along = normalized(side.along), across = normalized(side.across);
    for (const Place& place : places) {
        const Point on_floor = side.middle + spacing * place.right * along + (from_wall + spacing * place.in) * across;
        if (!rooms.holds(room, on_floor, observer_clearance)) continue;
        const Point eye = on_floor + Vec3{0, 0, eye_height};
        if (is_free(stage, eye)) return eye;
    }
    return std::nullopt;
}

}  // namespace

std::vector<Observer> room_observers(const Stage& stage, const FloorRooms& rooms) {
    std::vector<Observer> out;
    for (std::size_t room = 0; room < rooms.count(); ++room) {
        const MeasuringPlane& r = rooms[room].rectangle;
        const Point middle = r.origin + 0.5 * (r.u + r.v);
        const std::array<Side, 4> sides{{{middle - 0.5 * r.u, r.v, r.u},
                                         {middle + 0.5 * r.u, r.v, -1 * r.u},
                                         {middle - 0.5 * r.v, r.u, r.v},
                                         {middle + 0.5 * r.v, r.u, -1 * r.v}}};
        for (const Side& side : sides) {
            const std::optional<Point> eye = place_at(stage, rooms, room, side);
            if (!eye) continue;
            const Vec3 view = normalized(side.across);
            const std::string words = words_of_view(view);
            out.push_back({rooms.count() > 1 ? fmt::format("{}, {}", rooms.label(room), words) : words, *eye, view});
            out.back().room = room;
        }
    }
    return out;
}

}  // namespace exitance
