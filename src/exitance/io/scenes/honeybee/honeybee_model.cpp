#include "exitance/io/scenes/honeybee/honeybee_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/honeybee/honeybee_materials.hpp"

namespace exitance {
namespace {

/// Number of metres in a model's unit of length.
std::optional<double> metres_in(const std::string& units) {
    if (units.empty() || units == "Meters") return 1;
    if (units == "Centimeters") return 1e-2;
    if (units == "Millimeters") return 1e-3;
    if (units == "Feet") return 0.3048;    // by definition
    if (units == "Inches") return 0.0254;  // by definition
    return std::nullopt;
}

/// Position of a sheet in the model, which decides the material that a modifier set gives it.
struct Host {
    const HoneybeeModifierSet* set = nullptr;  ///< Modifier set of the sheet's room; null outside of rooms.
    std::string face_type = "Wall";
};

class ModelReader {
  public:
    ModelReader(const std::string& path, const HoneybeeChoices& choices)
        : path_(path), choices_(choices), materials_(path, out_.findings) {}

    HoneybeeModel read() {
        const Result<std::string> bytes = read_whole_file(path_);
        if (!bytes) return error(bytes.error().message), std::move(out_);
        Json model;
        try {
            model = Json::parse(*bytes);
        } catch (const Json::parse_error& fault) {
            const auto end = bytes->begin() + static_cast<std::ptrdiff_t>(std::min(fault.byte, bytes->size()));
            const auto line = 1 + std::count(bytes->begin(), end, '\n');
            find(Finding::Kind::error, static_cast<int>(line), "is not valid JSON here",
                 "save the model again as HBJSON");
            return std::move(out_);
        }
        if (text_in(model, "type") != "Model") {
            error(fmt::format("is not a Honeybee model but '{}'", shown(text_in(model, "type"))),
                  "save the whole model as HBJSON");
            return std::move(out_);
        }
        read_model(model);
        return std::move(out_);
    }

  private:
    void find(Finding::Kind kind, int line, std::string message, std::string hint = "") {
        out_.findings.push_back({kind, path_, line, std::move(message), std::move(hint)});
    }
    void error(std::string message, std::string hint = "") {
        find(Finding::Kind::error, 0, std::move(message), std::move(hint));
    }

    void read_model(const Json& model) {
        const std::optional<double> unit = metres_in(text_in(model, "units"));
        if (!unit) return error(fmt::format("the unit of length '{}' is unknown", shown(text_in(model, "units"))));
        metres_ = *unit;
        out_.modifiers = materials_.read(honeybee_radiance(model));
        for (const Json& room : entries(model, "rooms")) read_room(room);
        const Host outside;
        for (const Json& face : entries(model, "orphaned_faces")) read_face(face, outside);
        for (const Json& aperture : entries(model, "orphaned_apertures")) read_part(aperture, outside, false);
        for (const Json& door : entries(model, "orphaned_doors")) read_part(door, outside, true);
        for (const Json& shade : entries(model, "orphaned_shades")) add_shade(shade, "context_modifier", outside);
        for (const Json& mesh : entries(model, "shade_meshes")) add_mesh(mesh);
        for (const Json& grid : entries(honeybee_radiance(model), "sensor_grids")) read_grid(grid);
        for (const Json& view : entries(honeybee_radiance(model), "views")) read_view(view);
        if (dynamic_ > 0)
            find(Finding::Kind::warning, 0,
                 fmt::format("{} with several states {} in the first of them",
                             dynamic_ == 1 ? "1 object" : fmt::format("{} objects", dynamic_),
                             dynamic_ == 1 ? "is" : "are"),
                 "reorder the states in the model to choose another one, or choose it by the hour with daylight "
                 "--states");
    }

    std::string modifier_of(const Json& object, const std::string& key, const Host& host) const {
        return materials_.modifier_of(object, state_of(object), key, host.set);
    }

    std::size_t state_of(const Json& object) const {
        const auto found = choices_.find(text_in(object, "identifier"));
        return found == choices_.end() ? 0 : found->second;
    }

    std::optional<std::vector<Point>> loop_of(const Json& points, const std::string& name) {
        std::vector<Point> out;
        for (const Json& point : points.is_array() ? points : entries(points, "none")) {
            const std::optional<Vec3> at = vector_of(point);
            if (!at) {
                error(fmt::format("'{}' has a corner that is not three finite numbers", shown(name)));
                return std::nullopt;
            }
            out.push_back(metres_ * *at);
        }
        if (out.size() >= 3) return out;
        error(fmt::format("'{}' has an outline of fewer than three corners", shown(name)));
        return std::nullopt;
    }

    std::optional<HoneybeeOutline> outline_of(const Json& object) {
        const std::string name = text_in(object, "identifier");
        const Json& geometry = member(object, "geometry");
        std::optional<std::vector<Point>> boundary = loop_of(member(geometry, "boundary"), name);
        if (!boundary) return std::nullopt;
        HoneybeeOutline out{std::move(*boundary)};
        for (const Json& hole : entries(geometry, "holes")) {
            std::optional<std::vector<Point>> loop = loop_of(hole, name);
            if (!loop) return std::nullopt;
            out.holes.push_back(std::move(*loop));
        }
        return out;
    }

    void read_room(const Json& room) {
        Host host;
        host.set = materials_.find_set(text_in(honeybee_radiance(room), "modifier_set"));
        for (const Json& face : entries(room, "faces")) read_face(face, host);
        read_shades(room, host);
    }

    void read_face(const Json& face, Host host) {
        host.face_type = text_in(face, "face_type");
        std::vector<HoneybeeOutline> openings;
        for (const char* key : {"apertures", "doors"})
            for (const Json& part : entries(face, key))
                if (std::optional<HoneybeeOutline> outline = read_part(part, host, key[0] == 'd'))
                    openings.push_back(std::move(*outline));
        read_shades(face, host);
        if (host.face_type == "AirBoundary") return;
        std::optional<HoneybeeOutline> outline = outline_of(face);
        if (!outline) return;
        const std::string boundary = text_in(member(face, "boundary_condition"), "type");
        const std::string group = host.face_type == "Floor"         ? "floor_set"
                                  : host.face_type == "RoofCeiling" ? "roof_ceiling_set"
                                                                    : "wall_set";
        const bool is_outer = boundary == "Outdoors" || boundary == "Ground";
        HoneybeeSheet sheet;
        sheet.name = text_in(face, "identifier");
        sheet.modifier = modifier_of(face, group + (is_outer ? ".exterior_modifier" : ".interior_modifier"), host);
        sheet.outlines.push_back(std::move(*outline));
        sheet.openings = std::move(openings);
        sheet.partner = partner_of(face);
        // No light reaches the outer side: the ground, or a part of the building that is not modelled, covers it.
        if (boundary == "Ground" || boundary == "Adiabatic" || boundary == "OtherSideTemperature")
            sheet.sides = HoneybeeSides::back;
        out_.sheets.push_back(std::move(sheet));
    }

    /// Reads an aperture or a door. Returns its outline, which is cut out of its face.
    std::optional<HoneybeeOutline> read_part(const Json& part, const Host& host, bool is_door) {
        std::optional<HoneybeeOutline> outline = outline_of(part);
        if (!outline) return std::nullopt;
        const bool inside = text_in(member(part, "boundary_condition"), "type") == "Surface",
                   on_wall = host.face_type == "Wall";
        std::string key;
        if (is_door)
            key = flag_in(part, "is_glass")
                      ? (inside ? "door_set.interior_glass_modifier" : "door_set.exterior_glass_modifier")
                  : inside  ? "door_set.interior_modifier"
                  : on_wall ? "door_set.exterior_modifier"
                            : "door_set.overhead_modifier";
        else
            key = inside                         ? "aperture_set.interior_modifier"
                  : flag_in(part, "is_operable") ? "aperture_set.operable_modifier"
                  : on_wall                      ? "aperture_set.window_modifier"
                                                 : "aperture_set.skylight_modifier";
        HoneybeeSheet sheet;
        sheet.name = text_in(part, "identifier");
        sheet.modifier = modifier_of(part, key, host);
        sheet.outlines = {*outline};
        sheet.partner = partner_of(part);
        out_.sheets.push_back(std::move(sheet));
        read_states(part, host);
        read_shades(part, host);
        return outline;
    }

    static std::string partner_of(const Json& object) {
        const Json& condition = member(object, "boundary_condition");
        const Json& names = entries(condition, "boundary_condition_objects");
        return text_in(condition, "type") == "Surface" && !names.empty() && names[0].is_string()
                   ? names[0].get<std::string>()
                   : std::string();
    }

    void read_shades(const Json& host_object, const Host& host) {
        for (const Json& shade : entries(host_object, "indoor_shades"))
            add_shade(shade, "shade_set.interior_modifier", host);
        for (const Json& shade : entries(host_object, "outdoor_shades"))
            add_shade(shade, "shade_set.exterior_modifier", host);
    }

    void add_shade(const Json& shade, const std::string& key, const Host& host) {
        std::optional<HoneybeeOutline> outline = outline_of(shade);
        if (!outline) return;
        HoneybeeSheet sheet;
        sheet.name = text_in(shade, "identifier");
        sheet.modifier = modifier_of(shade, key, host);
        sheet.outlines.push_back(std::move(*outline));
        out_.sheets.push_back(std::move(sheet));
        const std::size_t before = out_.dynamic.size();
        read_states(shade, host);
        if (out_.dynamic.size() > before) out_.dynamic.back().is_shade = true;
    }

    /// Reads the states of an object, and adds the shades of the chosen one to the scene.
    void read_states(const Json& object, const Host& host) {
        const Json& states = entries(honeybee_radiance(object), "states");
        if (states.size() > 1) ++dynamic_;
        if (states.empty()) return;
        HoneybeeDynamic& dynamic = out_.dynamic.emplace_back();
        dynamic.object = text_in(object, "identifier");
        dynamic.group = text_in(honeybee_radiance(object), "dynamic_group_identifier");
        for (const Json& state : states) {
            std::string modifier = honeybee_modifier_name(member(state, "modifier"));
            if (modifier.empty()) modifier = honeybee_modifier_name(member(honeybee_radiance(object), "modifier"));
            dynamic.states.push_back({std::move(modifier), shades_of(state, host)});
        }
        const std::size_t chosen = state_of(object);
        if (chosen >= states.size()) return;
        const std::vector<HoneybeeSheet>& shades = dynamic.states[chosen].shades;
        out_.sheets.insert(out_.sheets.end(), shades.begin(), shades.end());
    }

    std::vector<HoneybeeSheet> shades_of(const Json& state, const Host& host) {
        std::vector<HoneybeeSheet> out;
        for (const Json& shade : entries(state, "shades")) {
            std::optional<HoneybeeOutline> outline = outline_of(shade);
            if (!outline) continue;
            std::string modifier = honeybee_modifier_name(member(shade, "modifier"));
            if (modifier.empty()) modifier = materials_.from_sets("shade_set.exterior_modifier", host.set);
            out.push_back({text_in(shade, "identifier"), std::move(modifier), {std::move(*outline)}});
        }
        return out;
    }

    void add_mesh(const Json& mesh) {
        HoneybeeSheet sheet;
        sheet.name = text_in(mesh, "identifier");
        sheet.modifier = modifier_of(mesh, "context_modifier", {});
        const Json &geometry = member(mesh, "geometry"), &vertices = entries(geometry, "vertices");
        std::vector<Point> points;
        for (const Json& vertex : vertices) {
            const std::optional<Vec3> at = vector_of(vertex);
            if (!at)
                return error(
                    fmt::format("shade mesh '{}' has a vertex that is not three finite numbers", shown(sheet.name)));
            points.push_back(metres_ * *at);
        }
        for (const Json& face : entries(geometry, "faces")) {
            HoneybeeOutline outline;
            for (const Json& corner : face) {
                if (!corner.is_number_unsigned() || corner.get<std::size_t>() >= points.size())
                    return error(
                        fmt::format("a face of shade mesh '{}' names a vertex that does not exist", shown(sheet.name)));
                outline.boundary.push_back(points[corner.get<std::size_t>()]);
            }
            sheet.outlines.push_back(std::move(outline));
        }
        out_.sheets.push_back(std::move(sheet));
    }

    void read_grid(const Json& grid) {
        HoneybeeGrid out{.name = text_in(grid, "identifier")};
        for (const Json& sensor : entries(grid, "sensors")) {
            const std::optional<Vec3> at = vector_of(member(sensor, "pos")), towards = vector_of(member(sensor, "dir"));
            if (!at || !towards || !(norm(*towards) > 0))
                return error(fmt::format("sensor {} of grid '{}' has no position or no direction",
                                         out.points.size() + 1, shown(out.name)));
            out.points.push_back(metres_ * *at), out.normals.push_back(normalized(*towards));
        }
        if (!out.points.empty()) out_.grids.push_back(std::move(out));
    }

    void read_view(const Json& view) {
        const std::string type = text_in(view, "view_type"), name = text_in(view, "identifier");
        const std::optional<Vec3> at = vector_of(member(view, "position")),
                                  towards = vector_of(member(view, "direction")),
                                  up = vector_of(member(view, "up_vector"));
        const bool is_parallel = type == "l";
        if (!is_parallel && at && towards && norm(*towards) > 0)
            out_.eyes.push_back({name, metres_ * *at, normalized(*towards)});
        if (!type.empty() && type != "v" && !is_parallel)
            return find(
                Finding::Kind::warning, 0,
                fmt::format("view '{}' is neither a perspective nor a parallel one, and is left out", shown(name)));
        const Json& width = member(view, "h_size");
        const double h = width.is_number() ? width.get<double>() : 60;  // honeybee-schema
        const bool is_sane = is_parallel ? h > 0 : h > 0 && h < 180;
        if (!at || !towards || !up || !is_sane || !(norm(cross(*towards, *up)) > 0))
            return error(fmt::format("view '{}' has no position, direction, upward vector or angle", shown(name)));
        SceneCamera camera;
        camera.name = name, camera.eye = metres_ * *at, camera.target = camera.eye + metres_ * *towards;
        camera.up = normalized(*up);
        if (is_parallel)
            camera.width = metres_ * h;
        else
            camera.fov = h;
        out_.views.push_back(std::move(camera));
    }

    const std::string& path_;
    const HoneybeeChoices& choices_;
    HoneybeeModel out_;
    double metres_ = 1;
    std::size_t dynamic_ = 0;  ///< Objects with several states.
    HoneybeeMaterials materials_;
};

}  // namespace

std::optional<Error> HoneybeeModel::first_error(const std::string& path) const {
    for (const Finding& finding : findings)
        if (finding.kind == Finding::Kind::error)
            return Error{ErrorCode::bad_input, finding.message, path, finding.hint};
    return {};
}

bool is_honeybee_file(const std::string& path) {
    const std::string end = ending(path);
    if (end != ".json" || path.ends_with(".city.json")) return end == ".hbjson";
    const Result<std::string> bytes = read_whole_file(path);
    if (!bytes) return false;
    const auto says_type = [&](std::string_view wanted) {
        constexpr std::string_view key = "\"type\"", blanks = " \t\r\n";
        for (std::size_t at = bytes->find(key); at != bytes->npos; at = bytes->find(key, at + 1)) {
            const std::size_t colon = bytes->find_first_not_of(blanks, at + key.size());
            if (colon == bytes->npos || (*bytes)[colon] != ':') continue;
            const std::size_t value = bytes->find_first_not_of(blanks, colon + 1);
            if (value != bytes->npos && bytes->compare(value, wanted.size(), wanted) == 0) return true;
        }
        return false;
    };
    return !says_type("\"CityJSON\"") && says_type("\"Model\"");
}

HoneybeeModel read_honeybee_model(const std::string& path, const HoneybeeChoices& choices) {
    return ModelReader(path, choices).read();
}

}  // namespace exitance
