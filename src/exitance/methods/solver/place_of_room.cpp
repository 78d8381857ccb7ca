#include "exitance/methods/solver/place_of_room.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace exitance {

std::string place_of_room(const Stage& stage, std::size_t room) {
    constexpr std::size_t max_names = 3;
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
    std::string text = fmt::format("of {:.4g} m^2", stage.rooms.area(room));
    if (objects.empty()) return text;
    std::stable_sort(objects.begin(), objects.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    text += fmt::format(" between ({:.4g}, {:.4g}, {:.4g}) and ({:.4g}, {:.4g}, {:.4g}) with ", box.lo.x, box.lo.y,
                        box.lo.z, box.hi.x, box.hi.y, box.hi.z);
    const std::size_t named = std::min(max_names, objects.size());
    for (std::size_t i = 0; i < named; ++i)
        text += fmt::format("{}'{}'", i == 0 ? "" : i + 1 == objects.size() ? " and " : ", ", objects[i].second);
    if (objects.size() > named)
        text += fmt::format(" and {} more object{}", objects.size() - named, objects.size() == named + 1 ? "" : "s");
    return text;
}

}  // namespace exitance
