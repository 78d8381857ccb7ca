#include "exitance/measure/floor_rooms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "exitance/measure/floor_bounds.hpp"

namespace exitance {
namespace {

constexpr double min_area = 1;           ///< m^2
constexpr double min_floor_share = 0.1;  ///< Share of the largest floor's area; derived from models out of scale.
constexpr double person = 1.9;           ///< Metres; derived from the height of people: lower spaces are not rooms.
constexpr double cupboard_share = 0.75;  ///< Part of a room's height; derived from cupboards: below it is furniture.
constexpr double min_breadth = 0.6;      ///< Metres; derived from treads of stairs, shelves and window sills.
constexpr double min_breadth_share =     ///< Share of the root of the largest area, derived from models out of scale.
    0.12;
constexpr std::size_t max_floors = 256;  ///< Derived from a few seconds of ray casting.
constexpr std::size_t max_rooms = 64;

/// Floors that are large enough for rooms, the largest first.
std::vector<Floor> large_floors(const Scene& scene) {
    std::vector<FloorShape> shapes;
    for (const RegionId id : scene.regions().ids())
        if (points_up(scene.regions()[id].plane.n)) shapes.push_back(floor_shape(scene.regions()[id], id));
    std::vector<Floor> floors = join_shapes(std::move(shapes));
    if (floors.empty()) return floors;
    const double least = std::min(min_area, min_floor_share * floors[0].area);
    std::erase_if(floors, [&](const Floor& f) { return f.area < least; });
    if (floors.size() > max_floors) floors.resize(max_floors);
    return floors;
}

/// Removes words for "floor" from the name of a group: "kitchen_floor" becomes "kitchen".
std::string name_of_room(const std::string& group) {
    std::string out, word;
    const auto finish = [&] {
        std::string small;
        for (const char c : word) small += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        for (const char* floor : {"floor", "floors", "ground", "slab", "boden", "default", "mesh", "object"})
            if (small == floor) word.clear();
        if (!word.empty()) out += (out.empty() ? "" : "_") + word;
        word.clear();
    };
    for (const char c : group) c == '_' || c == '.' || c == '-' || c == ' ' || c == '|' ? finish() : word.push_back(c);
    finish();
    return std::all_of(out.begin(), out.end(), [](unsigned char c) { return std::isdigit(c) || c == '_'; }) ? "" : out;
}

/// Group of the face at a point of a shape.
const std::string& group_at(const Scene& scene, const FloorShape& shape, const Point& p) {
    const std::vector<SurfaceId>& faces = scene.regions()[shape.region].surfaces;
    const auto at = std::find_if(faces.begin(), faces.end(),
                                 [&](SurfaceId s) { return contains(scene.outline(s), shape.plane.n, p); });
    return scene.groups()[scene.surfaces()[at == faces.end() ? faces.front() : *at].group];
}

}  // namespace

FloorRooms::FloorRooms(const Scene& scene, const RayTracer& tracer) {
    const double top = scene.box().hi.z;
    for (Floor& floor : large_floors(scene)) storeys_.emplace_back(std::move(floor), top, tracer);
    find_rooms(scene, tracer);
}

void FloorRooms::find_rooms(const Scene& scene, const RayTracer& tracer) {
    double largest = 0;
    for (const FloorCells& storey : storeys_)
        for (const FloorCells::Part& part : storey.parts()) largest = std::max(largest, part.area);
    const double least = std::min(min_area, min_floor_share * largest);
    const double narrowest = std::min(min_breadth, min_breadth_share * std::sqrt(largest));
    for (std::size_t s = 0; s < storeys_.size(); ++s)
        for (std::uint32_t k = 0; k < storeys_[s].parts().size(); ++k) {
            const FloorCells::Part& part = storeys_[s].parts()[k];
            if (part.area >= least && part.breadth >= narrowest)
                rooms_.push_back({"", part.area, part.height, {}, s, k});
        }
    leave_out_roofs();
    leave_out_furniture(scene, tracer);
    std::stable_sort(rooms_.begin(), rooms_.end(),
                     [](const FloorRoom& a, const FloorRoom& b) { return a.area > b.area; });
    if (rooms_.size() > max_rooms) rooms_.resize(max_rooms);
    for (FloorRoom& room : rooms_) room.rectangle = storeys_[room.storey].rectangle(room.part);
    name_rooms(scene);
}

/// Removes the insides of bodies, spaces that are too low and, if some rooms have a ceiling, those without.
void FloorRooms::leave_out_roofs() {
    const auto is_inside = [&](const FloorRoom& r) { return storeys_[r.storey].parts()[r.part].is_inside_body; };
    // If all rooms are inside bodies, all faces of the model are turned: keep them.
    if (!std::all_of(rooms_.begin(), rooms_.end(), is_inside)) std::erase_if(rooms_, is_inside);
    const auto has_ceiling = [&](const FloorRoom& r) { return storeys_[r.storey].parts()[r.part].has_ceiling; };
    double tallest = 0;
    for (const FloorRoom& room : rooms_)
        if (has_ceiling(room)) tallest = std::max(tallest, room.height);
    if (tallest == 0) return;
    const double least = std::min(person, 0.5 * tallest);
    const bool any = std::any_of(rooms_.begin(), rooms_.end(),
                                 [&](const FloorRoom& r) { return has_ceiling(r) && r.height >= least; });
    if (any) std::erase_if(rooms_, [&](const FloorRoom& r) { return !has_ceiling(r) || r.height < least; });
}

bool FloorRooms::is_above(const Point& p, const FloorRoom& room) const {
    const Floor& floor = storeys_[room.storey].floor();
    const Point below{p.x, p.y, level(room)};
    return std::any_of(floor.shapes.begin(), floor.shapes.end(), [&](const FloorShape& shape) {
        // Holes in a floor are the places of bodies that stand on it.
        return std::any_of(shape.loops.begin(), shape.loops.end(),
                           [&](const std::vector<Point>& loop) { return contains(loop, shape.plane.n, below); });
    });
}

/// Removes faces that are mostly above the floor of a lower room, by less than the height of a person, and the tops of
/// bodies in lower rooms.
void FloorRooms::leave_out_furniture(const Scene& scene, const RayTracer& tracer) {
    std::stable_sort(rooms_.begin(), rooms_.end(),
                     [&](const FloorRoom& a, const FloorRoom& b) { return level(a) < level(b); });
    std::vector<FloorRoom> kept;
    for (const FloorRoom& room : rooms_) {
        const FloorCells& storey = storeys_[room.storey];
        std::size_t above = 0;
        for (std::size_t i = 0; i < storey.size(); ++i) {
            if (storey.part(i) != room.part) continue;
            above += std::any_of(kept.begin(), kept.end(), [&](const FloorRoom& lower) {
                const double rise = level(room) - level(lower);
                const Point below = storey.centre(i) - Vec3{0, 0, rise};
                const bool has_ceiling = storeys_[lower.storey].parts()[lower.part].has_ceiling;
                return rise < (has_ceiling ? std::min(person, cupboard_share * lower.height) : person) + one_plane &&
                       storeys_[lower.storey].holds(lower.part, below, 0);
            });
        }
        if (2 * above > storey.parts()[room.part].cells) continue;
        if (kept.empty() || !is_body_in(kept, room, scene, tracer)) kept.push_back(room);
    }
    rooms_ = std::move(kept);
}

/// True if a room is the top of a body that is in one of the `lower` rooms, such as a rack or an air duct.
bool FloorRooms::is_body_in(const std::vector<FloorRoom>& lower, const FloorRoom& room, const Scene& scene,
                            const RayTracer& tracer) const {
    const double own = level(room);
    // The highest room that contains a place counts: floors of several storeys are above each other. If several rooms
    // have one floor, the largest counts.
    const auto find_lower_room = [&](const Point& p) {
        std::optional<LowerRoom> out;
        for (const FloorRoom& r : lower) {
            if (level(r) >= own - one_plane || level(r) > p.z + one_plane || !is_above(p, r)) continue;
            if (!out || std::pair(level(r), r.area) > std::pair(out->level, out->area)) out = {level(r), r.area};
        }
        return out;
    };
    return is_top_of_body(scene, tracer, storeys_[room.storey], room.part, find_lower_room);
}

/// Names a room by the group of its floor's faces, if nearly all of them are in one group and no other room's are.
void FloorRooms::name_rooms(const Scene& scene) {
    constexpr double nearly_all = 0.9;    // derived from thresholds and mats, which may have groups of their own
    constexpr std::size_t samples = 200;  // number of cells examined per room; at least half as many are examined
    std::map<std::string, std::size_t> uses;
    for (FloorRoom& room : rooms_) {
        const FloorCells& storey = storeys_[room.storey];
        const std::size_t stride = std::max<std::size_t>(1, storey.parts()[room.part].cells / samples);
        std::map<std::string, std::size_t> cells;
        std::size_t seen = 0, used = 0;
        for (std::size_t i = 0; i < storey.size(); ++i) {
            if (storey.part(i) != room.part || seen++ % stride != 0) continue;
            const Point p = storey.centre(i);
            ++cells[group_at(scene, storey.floor().shapes[storey.floor().shape_at(p)], p)], ++used;
        }
        for (const auto& [group, count] : cells)
            if (static_cast<double>(count) >= nearly_all * static_cast<double>(used)) room.name = name_of_room(group);
        ++uses[room.name];
    }
    for (FloorRoom& room : rooms_)
        if (uses[room.name] > 1) room.name.clear();
}

std::string FloorRooms::label(std::size_t room) const {
    const std::string& name = rooms_[room].name;
    return fmt::format("room {}{}", room + 1, name.empty() ? "" : fmt::format(" ({})", name));
}

std::size_t FloorRooms::at(const Point& p) const {
    std::size_t found = count();
    double nearest = HUGE_VAL;
    for (std::size_t i = 0; i < count(); ++i) {
        const double rise = p.z - floor(i).shapes[0].loops[0][0].z;
        if (rise < -one_plane || rise >= nearest || rise > rooms_[i].height) continue;
        if (holds(i, p - Vec3{0, 0, rise}, 0)) found = i, nearest = rise;
    }
    return found;
}

}  // namespace exitance
