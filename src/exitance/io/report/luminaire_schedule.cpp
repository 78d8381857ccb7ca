#include "exitance/io/report/luminaire_schedule.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exitance/io/report/report_figures.hpp"

namespace exitance {
namespace {

/// "A" to "Z", then "AA", "AB", ...
std::string letters(std::size_t number) {
    constexpr std::size_t alphabet = 26;
    std::string out(1, static_cast<char>('A' + number % alphabet));
    return number < alphabet ? out : letters(number / alphabet - 1) + out;
}

/// Flux that the faces of every group emit in the solution, lm.
std::vector<double> flux_of_groups(const Scene& scene) {
    const LightUnit lumens(UnitChoice::lux, scene.is_photometric());
    std::vector<double> out(scene.groups().size());
    for (const SurfaceId s : scene.emitters()) {
        const Surface& surface = scene.surfaces()[s];
        out[surface.group.value] += surface.area * lumens(scene.material(s).exitance);
    }
    return out;
}

/// Index of the type of a luminaire; adds it if it is new.
std::size_t type_of(const InstalledLuminaire& luminaire, const Scene& scene, LuminaireSchedule& schedule) {
    constexpr double equal = 1e-6;  // relative difference; derived from the rounding of the flux
    const LuminaireType* facts = &scene.luminaire_types()[luminaire.type];
    for (std::size_t i = 0; i < schedule.types.size(); ++i) {
        const LuminaireSchedule::Type& type = schedule.types[i];
        if (type.facts == facts && std::abs(type.flux - luminaire.flux) <= equal * type.flux) return i;
    }
    LuminaireSchedule::Type type;
    type.label = letters(schedule.types.size()), type.facts = facts, type.flux = luminaire.flux;
    schedule.types.push_back(std::move(type));
    return schedule.types.size() - 1;
}

/// Room of a luminaire; its opening may be in the plane of the ceiling.
std::optional<std::size_t> room_of(const FloorRooms& rooms, const Point& position) {
    constexpr double below = 0.1;  // metres; derived from lamps recessed in the ceiling
    for (const double down : {0.0, below})
        if (const std::size_t room = rooms.at(position - Vec3{0, 0, down}); room < rooms.count()) return room;
    return std::nullopt;
}

void add_items(const ReportContent& content, LuminaireSchedule& schedule) {
    const Scene& scene = content.solution->scene;
    const std::vector<double> emitted = flux_of_groups(scene);
    for (const InstalledLuminaire& luminaire : scene.luminaires()) {
        const std::size_t t = type_of(luminaire, scene, schedule);
        LuminaireSchedule::Type& type = schedule.types[t];
        const double maintained = luminaire.flux * luminaire.maintenance;
        type.output.add(maintained > 0 ? emitted[luminaire.group] / maintained : 0);
        type.maintenance.add(luminaire.maintenance);
        schedule.items.push_back(
            {fmt::format("{}{}", type.label, ++type.count), t, &luminaire, room_of(content.rooms, luminaire.position)});
    }
}

/// Mean illuminance on the largest horizontal plane of a room's task areas, lx.
std::optional<double> light_in_room(std::size_t room, const ReportContent& content, const ReportFigures& figures) {
    std::optional<double> out;
    double largest = 0;
    for (const ReportFigures::Grid& grid : figures.grids) {
        const GridLight& light = *grid.light;
        const double area = norm(light.plane.u) * norm(light.plane.v);
        if (light.room != room || light.is_cylindrical || light.zone != PlaneZone::task || area <= largest) continue;
        if (content.unit.is_lux() && grid.levels.mean > 0) largest = area, out = grid.levels.mean;
    }
    return out;
}

void add_rooms(const ReportContent& content, const ReportFigures& figures, LuminaireSchedule& schedule) {
    for (std::size_t room = 0; room < content.rooms.count(); ++room) {
        LuminaireSchedule::Room out;
        out.room = room, out.watts = 0, out.light = light_in_room(room, content, figures);
        for (const LuminaireSchedule::Item& item : schedule.items) {
            if (item.room != room) continue;
            ++out.counts[item.type];
            const double watts = schedule.types[item.type].facts->watts;
            if (out.watts) out.watts = watts > 0 ? std::optional(*out.watts + watts) : std::nullopt;
        }
        if (out.counts.empty()) continue;
        out.watts_per_area = out.watts.value_or(0) / content.rooms[room].area;
        schedule.rooms.push_back(std::move(out));
    }
}

void add_others(const Scene& scene, LuminaireSchedule& schedule) {
    std::vector<bool> is_luminaire(scene.groups().size());
    for (const InstalledLuminaire& luminaire : scene.luminaires()) is_luminaire[luminaire.group] = true;
    const LightUnit lumens(UnitChoice::lux, scene.is_photometric());
    std::map<std::string, LuminaireSchedule::Other> others;
    for (const SurfaceId s : scene.emitters()) {
        const Surface& surface = scene.surfaces()[s];
        if (is_luminaire[surface.group.value]) continue;
        LuminaireSchedule::Other& other = others[scene.material(s).name];
        other.material = scene.material(s).name, ++other.faces, other.area += surface.area;
        other.flux += surface.area * lumens(scene.material(s).exitance);
    }
    for (auto& [name, other] : others) schedule.others.push_back(std::move(other));
}

}  // namespace

LuminaireSchedule find_schedule(const ReportContent& content, const ReportFigures& figures) {
    LuminaireSchedule out;
    add_items(content, out);
    add_rooms(content, figures, out);
    add_others(content.solution->scene, out);
    return out;
}

}  // namespace exitance
