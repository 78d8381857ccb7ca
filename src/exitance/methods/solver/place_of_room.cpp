#include "exitance/methods/solver/place_of_room.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "exitance/transport/body_surroundings.hpp"

namespace exitance {
namespace {

/// "'walls', 'floor' and 3 more objects"
std::string list_of(const std::vector<std::string>& names, const std::string& kind) {
    constexpr std::size_t max_names = 3;
    const std::size_t named = std::min(max_names, names.size());
    std::string text;
    for (std::size_t i = 0; i < named; ++i)
        text += fmt::format("{}'{}'", i == 0 ? "" : i + 1 == names.size() ? " and " : ", ", names[i]);
    if (names.size() > named)
        text += fmt::format(" and {} more {}{}", names.size() - named, kind, names.size() == named + 1 ? "" : "s");
    return text;
}

/// Names of the bodies that a room surrounds, the largest body first.
std::vector<std::string> surrounded_bodies(const Stage& stage, std::size_t room) {
    std::vector<std::string> out;
    if (!stage.rooms.is_surroundings(room)) return out;
    const Scene& scene = stage.scene;
    for (const SurfaceId s : stage.rooms.surroundings()->bodies()) {
        const Surface& surface = scene.surfaces()[s];
        const std::string& name = scene.groups()[surface.group];
        if (stage.rooms.at(surface.region, centroid(scene.outline(s))) == room &&
            std::find(out.begin(), out.end(), name) == out.end())
            out.push_back(name);
    }
    return out;
}

}  // namespace

std::string place_of_room(const Stage& stage, std::size_t room) {
    const Scene& scene = stage.scene;
    Box box;
    Field<GroupId, double> area(scene.groups().size(), 0.0);
    for (const SurfaceId s : scene.surfaces().ids()) {
        const Surface& surface = scene.surfaces()[s];
        if (stage.is_unlit(surface.region) || stage.rooms.at(surface.region, centroid(scene.outline(s))) != room)
            continue;
        for (const Point& corner : scene.outline(s)) box.add(corner);
        area[surface.group] += surface.area;
    }
    std::vector<std::pair<double, std::string>> objects;
    for (const GroupId g : area.ids())
        if (area[g] > 0) objects.emplace_back(area[g], scene.groups()[g]);
    const std::vector<std::string> bodies = surrounded_bodies(stage, room);
    std::string text = bodies.empty() ? fmt::format("room of {:.4g} m^2", stage.rooms.area(room))
                                      : fmt::format("surroundings of {}, {:.4g} m^2", list_of(bodies, "object"),
                                                    stage.rooms.area(room));
    if (objects.empty()) return text;
    std::stable_sort(objects.begin(), objects.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    text += fmt::format(" between ({:.4g}, {:.4g}, {:.4g}) and ({:.4g}, {:.4g}, {:.4g})", box.lo.x, box.lo.y, box.lo.z,
                        box.hi.x, box.hi.y, box.hi.z);
    if (!bodies.empty()) return text;
    std::vector<std::string> names;
    for (const auto& object : objects) names.push_back(object.second);
    return text + " with " + list_of(names, "object");
}

}  // namespace exitance
