#include "exitance/io/export/viewer_data.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "exitance/io/export/viewer_part.hpp"
#include "exitance/io/pictures/tone_map.hpp"

namespace exitance {
namespace {

using nlohmann::json;

/// Limit on the links that are drawn for a selected element.
constexpr std::size_t max_links = 400;

json json_numbers(const Point& p) {
    return {p.x, p.y, p.z};
}
json json_numbers(const Spectrum& s) {
    return red_green_blue(s);
}

/// Weights of red, green and blue for one number in `unit`. If the number of bands is not three, the weights are equal.
json colour_weights(const LightUnit& unit) {
    if constexpr (bands != 3) {
        const double third = unit(Spectrum(1.0)) / 3;
        return {third, third, third};
    }
    json out = json::array();
    for (std::size_t b = 0; b < bands; ++b) {
        Spectrum one;
        one[b] = 1;
        out.push_back(unit(one));
    }
    return out;
}

/// The links to the element that contains a point, and to its ancestors.
json links_at(const Solution& solution, RegionId region, const Point& x) {
    json out = json::array();
    if (solution.links.links.empty()) return out;
    const ElementTree& tree = solution.links.elements.tree;
    const ElementLocator locator(tree, solution.scene.regions().size());
    std::vector<KeptLink> found;
    for (ElementId e = locator.find(region, x).element; !e.is_none(); e = tree.parent(e)) {
        const auto [first, last] =
            std::equal_range(solution.links.links.begin(), solution.links.links.end(), KeptLink{e, {}, 0},
                             [](const KeptLink& a, const KeptLink& b) { return a.receiver.value < b.receiver.value; });
        found.insert(found.end(), first, last);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const KeptLink& a, const KeptLink& b) { return a.form_factor > b.form_factor; });
    if (found.size() > max_links) found.resize(max_links);
    for (const KeptLink& link : found) {
        json outline = json::array();
        for (const Point& p : tree.outline(link.source)) outline.push_back(json_numbers(p));
        out.push_back({{"outline", std::move(outline)}, {"form_factor", link.form_factor}});
    }
    return out;
}

}  // namespace

std::string viewer_scene_json(const Solution& solution, const Camera& camera, const LightUnit& unit) {
    json materials = json::array();
    for (const Material& m : solution.scene.materials())
        materials.push_back(
            {{"name", m.name}, {"reflectance", json_numbers(m.reflectance)}, {"exitance", json_numbers(m.exitance)}});
    json groups = json::array();
    for (const std::string& name : solution.scene.groups()) groups.push_back(name);
    const Box& box = solution.scene.box();
    json out{
        {"file", solution.scene.file()},
        {"lux", unit.is_lux()},
        {"weights", colour_weights(unit)},
        {"surfaces", solution.scene.surfaces().size()},
        {"elements", solution.statistics.leaf_elements},
        {"method", solution.statistics.method},
        {"materials", std::move(materials)},
        {"exposure", make_tone_map(solution).scale},
        {"camera", {{"eye", json_numbers(camera.eye)}, {"target", json_numbers(camera.target)}, {"fov", camera.fov}}},
        {"box", {json_numbers(box.lo), json_numbers(box.hi)}},
        {"parts",
         {{"exported", viewer_part_count(solution, ViewerLayer::exported)},
          {"method", viewer_part_count(solution, ViewerLayer::method)},
          {"raw", viewer_part_count(solution, ViewerLayer::raw)}}},
        {"basis", solution.statistics.basis},
        {"groups", std::move(groups)},
        {"shadow_classes", !solution.discontinuity.shadow.empty()},
        {"discontinuities", !solution.discontinuity.empty()},
        {"links", solution.links.links.size()}};
    const auto& error = solution.statistics.relative_error_estimate;
    out["error"] = error ? json(*error) : json(nullptr);
    return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string viewer_point_json(const RadiosityFunction& light, const ProbePoint& point) {
    const Solution& solution = light.solution();
    const std::span<const ProbePoint> points(&point, 1);
    const Light total = light.at(points)[0];
    json out{{"irradiance", json_numbers(total.irradiance)},
             {"direct", json_numbers(light.at(points, Component::direct)[0].irradiance)},
             {"indirect", json_numbers(light.at(points, Component::indirect)[0].irradiance)}};
    const Locator locator(solution.scene);
    const SurfaceId s = locator.find(point.x, point.n);
    if (total.on_surface && !s.is_none()) {
        const Scene& scene = solution.scene;
        const Surface& surface = scene.surfaces()[s];
        const ElementLocator elements(solution.interpolant.tree, scene.regions().size());
        const ElementId e = elements.find(surface.region, point.x).element;
        out["radiosity"] = json_numbers(total.radiosity);
        out["surface"] = s.value, out["line"] = surface.line;
        out["material"] = scene.material(s).name;
        out["group"] = surface.group.is_none() ? "" : scene.groups()[surface.group];
        out["element"] = e.is_none() ? json(nullptr) : json(e.value);
        out["links"] = links_at(solution, surface.region, point.x);
    }
    return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string viewer_line_json(const RadiosityFunction& light, const Point& from, const Point& to, const Normal& n,
                             std::size_t count, const LightUnit& unit) {
    std::vector<ProbePoint> points;
    for (std::size_t i = 0; i < count; ++i) {
        const double t = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0;
        points.push_back({from + t * (to - from), n});
    }
    json values = json::array(), delivered = json::array(), raw = json::array();
    for (const Light& l : light.at(points)) values.push_back(unit(l.irradiance));
    for (const Light& l : light.interpolant_at(points)) delivered.push_back(unit(l.irradiance));
    for (const Spectrum& e : viewer_raw_at(light, points)) raw.push_back(unit(e));
    return json{{"length", norm(to - from)},
                {"values", std::move(values)},
                {"delivered", std::move(delivered)},
                {"raw", std::move(raw)}}
        .dump();
}

}  // namespace exitance
