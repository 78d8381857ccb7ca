#include "exitance/io/report/report_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/version.hpp"
#include "exitance/base/words.hpp"
#include "exitance/io/files/base64.hpp"
#include "exitance/io/pictures/tone_map.hpp"
#include "exitance/io/report/requirements.hpp"

namespace exitance {
namespace {

ReportFigures::Face face_figures(const ReportContent& content, const SurfacePoints& points) {
    const Scene& scene = content.solution->scene;
    const Surface& surface = scene.surfaces()[points.surface];
    ReportFigures::Face face;
    face.surface = points.surface, face.line = surface.line, face.area = surface.area;
    face.group = scene.groups()[surface.group], face.material = scene.material(points.surface).name;
    std::vector<double> values;
    for (const Light& light : points.light) {
        values.push_back(content.unit(light.irradiance));
        face.radiosity += content.unit(light.radiosity) / static_cast<double>(points.light.size());
    }
    face.irradiance = levels_of(values);
    return face;
}

/// Adds the faces of a material of the same name. Colours become means, weighted by area.
void add(ReportFigures::MaterialUse& use, const ReportFigures::MaterialUse& other) {
    const double area = use.area + other.area, share = area > 0 ? other.area / area : 0.5;
    for (std::size_t c = 0; c < use.reflectance.size(); ++c) {
        use.reflectance[c] = std::lerp(use.reflectance[c], other.reflectance[c], share);
        use.radiance[c] = std::lerp(use.radiance[c], other.radiance[c], share);
    }
    use.faces += other.faces, use.area = area, use.irradiance += other.irradiance;
}

/// One row per name: a file may have several materials of one name, such as a window in each of its orientations.
std::vector<ReportFigures::MaterialUse> material_figures(const Scene& scene,
                                                         const std::vector<ReportFigures::Face>& faces) {
    std::vector<ReportFigures::MaterialUse> materials;
    for (const Material& m : scene.materials())
        materials.push_back(
            {m.name, red_green_blue(m.reflectance), red_green_blue(radiance_of_exitance(m.exitance)), 0, 0, 0});
    for (const Surface& surface : scene.surfaces()) {
        ReportFigures::MaterialUse& use = materials[surface.material.value];
        ++use.faces, use.area += surface.area;
    }
    std::vector<double> measured(materials.size());
    for (const ReportFigures::Face& face : faces) {
        const std::uint32_t m = scene.surfaces()[face.surface].material.value;
        if (face.irradiance.count == 0) continue;
        materials[m].irradiance += face.area * face.irradiance.mean, measured[m] += face.area;
    }
    std::vector<ReportFigures::MaterialUse> out;
    std::vector<double> measured_of;
    for (std::size_t m = 0; m < materials.size(); ++m) {
        if (materials[m].faces == 0) continue;
        const auto named =
            std::find_if(out.begin(), out.end(), [&](const auto& o) { return o.name == materials[m].name; });
        const auto k = static_cast<std::size_t>(named - out.begin());
        if (named == out.end())
            out.push_back(materials[m]), measured_of.push_back(measured[m]);
        else
            add(*named, materials[m]), measured_of[k] += measured[m];
    }
    for (std::size_t k = 0; k < out.size(); ++k)
        if (measured_of[k] > 0) out[k].irradiance /= measured_of[k];
    return out;
}

std::string numbers(std::span<const double> values) {
    std::string text;
    for (const double value : values) text += fmt::format("{}{}", text.empty() ? "" : ", ", figure(value));
    return fmt::format("[{}]", text);
}

std::string point(const Vec3& p) {
    return numbers(std::array<double, 3>{p.x, p.y, p.z});
}

std::string levels(const Levels& l) {
    if (l.count == 0) return R"("mean": null, "minimum": null, "maximum": null, "uniformity": null)";
    return fmt::format(R"("mean": {}, "minimum": {}, "maximum": {}, "uniformity": {})", figure(l.mean), figure(l.least),
                       figure(l.most), figure(l.uniformity()));
}

std::string grid_json(const ReportFigures::Grid& grid) {
    const GridLight& light = *grid.light;
    std::string points, values;
    for (std::size_t i = 0; i < light.points.size(); ++i) {
        points += fmt::format("{}{}", i > 0 ? ", " : "", point(light.points[i]));
        values += fmt::format("{}{}", i > 0 ? ", " : "", light.is_open[i] ? figure(grid.values[i]) : "null");
    }
    return fmt::format(
        "{{\"name\": {}, \"room\": {}, \"kind\": \"{}\", \"zone\": \"{}\", \"origin\": {}, \"u\": {}, \"v\": {}, "
        "\"normal\": {}, "
        "\"margin\": {}, "
        "\"columns\": {}, \"rows\": {}, "
        "\"spacing\": [{}, {}], {}, \"diversity\": {}, \"hidden\": {},\n     \"points\": [{}],\n     \"values\": "
        "[{}]}}",
        json_text(light.name), light.room ? std::to_string(*light.room + 1) : "null",
        light.is_cylindrical ? "cylindrical" : "plane", name_of(light.zone), point(light.plane.origin),
        point(light.plane.u), point(light.plane.v), point(light.n), figure(light.plane.margin), light.columns,
        light.rows, figure(light.step_u), figure(light.step_v), levels(grid.levels), figure(grid.levels.diversity()),
        grid.hidden, points, values);
}

std::string rooms_json(const FloorRooms& rooms) {
    std::string out;
    for (std::size_t i = 0; i < rooms.count(); ++i)
        out += fmt::format("{}{{\"label\": {}, \"name\": {}, \"area\": {}, \"height\": {}}}", i > 0 ? ", " : "",
                           json_text(rooms.label(i)), json_text(rooms[i].name), figure(rooms[i].area),
                           figure(rooms[i].height));
    return fmt::format("[{}]", out);
}

std::string face_json(const ReportFigures::Face& face) {
    return fmt::format(
        "{{\"surface\": {}, \"line\": {}, \"group\": {}, \"material\": {}, \"area\": {}, \"irradiance\": {{{}}}, "
        "\"radiosity\": {}, \"points\": {}}}",
        face.surface.value, face.line, json_text(face.group), json_text(face.material), figure(face.area),
        levels(face.irradiance), face.irradiance.count > 0 ? figure(face.radiosity) : "null", face.irradiance.count);
}

/// Formats the items of a JSON array, one per line.
template <class Items, class Text>
std::string list(const Items& items, const Text& text) {
    std::string out;
    for (const auto& item : items) out += fmt::format("{}\n    {}", out.empty() ? "" : ",", text(item));
    return out.empty() ? "[]" : fmt::format("[{}\n  ]", out);
}

}  // namespace

const char* symbol(const LightUnit& unit) {
    return unit.is_lux() ? "lx" : "W/m\xc2\xb2";
}

std::string figure(double value) {
    return std::isfinite(value) ? fmt::format("{:.5g}", value) : "null";
}

std::string short_figure(double value) {
    return std::abs(value) >= 100 && std::abs(value) < 1e6 ? fmt::format("{:.0f}", value)
                                                           : fmt::format("{:.3g}", value);
}

double shown_width(double width, double height) {
    constexpr double widest = 640,
                     highest = 400;  // pixels, derived from two drawings on a page of 267 mm at 96 pixels per inch
    return std::min(widest, highest * width / height);
}

Result<std::string> data_address(const Image& image) {
    const Result<std::string> png = encode_png(image, {});
    if (!png) return png.error();
    return fmt::format("data:image/png;base64,{}", base64(std::as_bytes(std::span(*png))));
}

ReportFigures find_figures(const ReportContent& content) {
    ReportFigures out;
    for (const SurfacePoints& points : content.surfaces) out.faces.push_back(face_figures(content, points));
    out.materials = material_figures(content.solution->scene, out.faces);
    for (const GridLight& light : content.grids) {
        ReportFigures::Grid grid{&light, {}, {}, 0};
        std::vector<double> open;
        for (std::size_t i = 0; i < light.points.size(); ++i) {
            grid.values.push_back(content.maintenance * content.unit(light.irradiance[i]));
            if (light.is_open[i]) open.push_back(grid.values.back());
            grid.hidden += !light.is_open[i] && (light.counts.empty() || light.counts[i]);
        }
        grid.levels = levels_of(open);
        out.grids.push_back(std::move(grid));
    }
    for (const Surface& surface : content.solution->scene.surfaces()) out.area += surface.area;
    out.luminaires = find_schedule(content, out);
    return out;
}

std::string report_json(const ReportContent& content, const ReportFigures& figures) {
    const Scene& scene = content.solution->scene;
    const bool lux = content.unit.is_lux();
    const Vec3 size = scene.box().size();
    return fmt::format(
        "{{\n  \"version\": 1,\n  \"generator\": \"exitance {}\",\n  \"unit\": \"{}\",\n"
        "  \"scene\": {{\"file\": {}, \"surfaces\": {}, \"area\": {}, \"size\": {}, \"emitters\": {}, \"lights\": "
        "{}}},\n"
        "  \"error\": {{\"median\": {}, \"error_p99\": {}, \"check_noise\": {}, \"check_points\": {}}},\n"
        "  \"heading\": {{\"title\": {}, \"project\": {}, \"client\": {}, \"author\": {}, \"date\": {}}},\n"
        "  \"requirements\": {},\n"
        "  \"pictures\": {},\n  \"rooms\": {},\n  \"luminaires\": {},\n  \"grids\": {},\n  \"maintenance\": {},\n  "
        "\"observers\": {},\n  "
        "\"materials\": {},\n  "
        "\"surfaces\": {},\n"
        "  \"surfaces_left_out\": {},\n  \"unfinished\": {},\n  \"statistics\": {},\n  \"options\": {}\n}}\n",
        program_version, lux ? "lx" : "W/m^2", json_text(scene.file()), scene.surfaces().size(), figure(figures.area),
        point(size), scene.emitters().size(), scene.lights().size(), figure(content.error.median),
        figure(content.error.p99), figure(content.error.noise), content.error.points, json_text(content.heading.title),
        json_text(content.heading.project), json_text(content.heading.client), json_text(content.heading.author),
        json_text(content.heading.date),
        list(judge(content, figures),
             [](const Judgement& j) {
                 return fmt::format(
                     "{{\"where\": {}, \"task\": {}, \"quantity\": {}, \"required\": {}, \"reached\": {}, \"verdict\": "
                     "{}}}",
                     json_text(j.where), json_text(j.task), json_text(j.quantity), figure(j.required),
                     figure(j.reached), json_text(words_of(j.verdict)));
             }),
        list(content.pictures,
             [](const ReportPicture& p) {
                 return fmt::format("{{\"caption\": {}, \"camera\": {}}}", json_text(p.caption), json_text(p.camera));
             }),
        rooms_json(content.rooms), schedule_json(figures.luminaires), list(figures.grids, grid_json),
        figure(content.maintenance), list(content.observers, observer_json),
        list(figures.materials,
             [](const ReportFigures::MaterialUse& m) {
                 return fmt::format(
                     "{{\"name\": {}, \"reflectance\": {}, \"radiance\": {}, \"surfaces\": {}, \"area\": {}, "
                     "\"irradiance\": {}}}",
                     json_text(m.name), numbers(m.reflectance), numbers(m.radiance), m.faces, figure(m.area),
                     figure(m.irradiance));
             }),
        list(figures.faces, face_json), content.surfaces_left_out,
        list(content.unfinished, [](const std::string& part) { return json_text(part); }),
        content.statistics.empty() ? "null" : content.statistics,
        content.solution->options.empty() ? "null" : content.solution->options);
}

}  // namespace exitance
