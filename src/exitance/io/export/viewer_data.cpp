#include "exitance/io/export/viewer_data.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "exitance/io/pictures/tone_map.hpp"

namespace exitance {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "numbers travel as they lie in memory");

/// Of the links that a picked element has, so many are drawn.
constexpr std::size_t most_links = 400;

struct Part {
    std::vector<float> positions, irradiance;
    std::vector<std::uint32_t> materials, elements, triangles, edges, orders;

    std::uint32_t add(const Point& p, const Spectrum& value, MaterialId material, std::uint32_t element) {
        for (const double x : {p.x, p.y, p.z}) positions.push_back(static_cast<float>(x));
        for (const double e : red_green_blue(value)) irradiance.push_back(static_cast<float>(e));
        materials.push_back(material.value), elements.push_back(element);
        return static_cast<std::uint32_t>(materials.size() - 1);
    }
    void add_edge(std::uint32_t a, std::uint32_t b, CurveOrder order) {
        edges.push_back(a), edges.push_back(b), orders.push_back(static_cast<std::uint32_t>(order));
    }
};

template <class T>
void append(std::string& out, const std::vector<T>& values) {
    out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

std::string packed(const Part& part) {
    const std::vector<std::uint32_t> counts{static_cast<std::uint32_t>(part.materials.size()),
                                            static_cast<std::uint32_t>(part.triangles.size() / 3),
                                            static_cast<std::uint32_t>(part.orders.size())};
    std::string out = "EXV1";
    append(out, counts), append(out, part.positions), append(out, part.irradiance), append(out, part.materials);
    append(out, part.elements), append(out, part.triangles), append(out, part.edges), append(out, part.orders);
    return out;
}

const ElementFunction& function_of(const Solution& solution, ViewerLayer layer) {
    return layer == ViewerLayer::exported ? solution.interpolant : solution.indirect;
}

/// Is what `export` writes a mesh of triangles with six nodes?
bool has_triangles(const Solution& solution, ViewerLayer layer) {
    return layer == ViewerLayer::exported && !solution.discontinuity.empty();
}

void add_leaf(Part& part, const Scene& scene, const ElementFunction& f, ElementId e) {
    const std::vector<Vec2> domain = f.tree.domain(e);
    const MaterialId material = scene.regions()[f.tree.region(e)].material;
    const auto first = static_cast<std::uint32_t>(part.materials.size());
    const auto n = static_cast<std::uint32_t>(domain.size());
    for (const Vec2 uv : domain) part.add(f.tree.patch(e).at(uv), f.at({e, uv}), material, e.value);
    for (std::uint32_t i = 0; i + 2 < n; ++i)
        for (const std::uint32_t k : {0u, i + 1, i + 2}) part.triangles.push_back(first + k);
    for (std::uint32_t i = 0; i < n; ++i) part.add_edge(first + i, first + (i + 1) % n, CurveOrder::none);
}

/// A quadratic triangle as four plain ones.
void add_triangle(Part& part, const Scene& scene, const SixNodeMesh& mesh, std::uint32_t t) {
    const MaterialId material = scene.regions()[mesh.region[t]].material;
    std::array<std::uint32_t, 6> v{};
    for (std::size_t i = 0; i < 6; ++i)
        v[i] = part.add(mesh.points[mesh.nodes[t][i]], mesh.value(mesh.nodes[t][i]), material, t);
    for (const std::array<std::size_t, 3>& c : {std::array<std::size_t, 3>{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}})
        for (const std::size_t k : c) part.triangles.push_back(v[k]);
    for (std::size_t i = 0; i < 3; ++i) part.add_edge(v[i], v[(i + 1) % 3], mesh.edge_order[t][i]);
}

json numbers(const Point& p) {
    return {p.x, p.y, p.z};
}
json numbers(const Spectrum& s) {
    return red_green_blue(s);
}

/// What is linked to the element that holds a point, or to one that it is part of.
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
    if (found.size() > most_links) found.resize(most_links);
    for (const KeptLink& link : found) {
        json outline = json::array();
        for (const Point& p : tree.outline(link.source)) outline.push_back(numbers(p));
        out.push_back({{"outline", std::move(outline)}, {"form_factor", link.form_factor}});
    }
    return out;
}

}  // namespace

std::size_t viewer_part_count(const Solution& solution, ViewerLayer layer) {
    const std::size_t leaves = has_triangles(solution, layer) ? solution.discontinuity.size()
                                                              : function_of(solution, layer).tree.leaves().size();
    return std::max<std::size_t>(1, (leaves + viewer_part_leaves - 1) / viewer_part_leaves);
}

std::string viewer_part(const Solution& solution, ViewerLayer layer, std::size_t number) {
    Part part;
    const std::size_t first = number * viewer_part_leaves;
    if (has_triangles(solution, layer)) {
        const SixNodeMesh& mesh = solution.discontinuity;
        for (std::size_t t = first; t < std::min(mesh.size(), first + viewer_part_leaves); ++t)
            add_triangle(part, solution.scene, mesh, static_cast<std::uint32_t>(t));
        return packed(part);
    }
    const ElementFunction& f = function_of(solution, layer);
    const std::vector<ElementId> leaves = f.tree.leaves();
    for (std::size_t i = first; i < std::min(leaves.size(), first + viewer_part_leaves); ++i)
        add_leaf(part, solution.scene, f, leaves[i]);
    return packed(part);
}

std::string viewer_scene_json(const RadiosityFunction& light, const Camera& camera) {
    const Solution& solution = light.solution();
    json materials = json::array();
    for (const Material& m : solution.scene.materials())
        materials.push_back(
            {{"name", m.name}, {"reflectance", numbers(m.reflectance)}, {"exitance", numbers(m.exitance)}});
    const Box& box = solution.scene.box();
    json out{{"file", solution.scene.file()},
             {"photometric", solution.scene.is_photometric()},
             {"surfaces", solution.scene.surfaces().size()},
             {"elements", solution.statistics.leaf_elements},
             {"method", solution.statistics.method},
             {"materials", std::move(materials)},
             {"exposure", make_tone_map(solution).scale},
             {"camera", {{"eye", numbers(camera.eye)}, {"target", numbers(camera.target)}, {"fov", camera.fov}}},
             {"box", {numbers(box.lo), numbers(box.hi)}},
             {"parts",
              {{"exported", viewer_part_count(solution, ViewerLayer::exported)},
               {"method", viewer_part_count(solution, ViewerLayer::method)}}},
             {"links", solution.links.links.size()}};
    const auto& error = solution.statistics.relative_error_estimate;
    out["error"] = error ? json(*error) : json(nullptr);
    return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string viewer_point_json(const RadiosityFunction& light, const ProbePoint& point) {
    const Solution& solution = light.solution();
    const std::span<const ProbePoint> points(&point, 1);
    const Light total = light.at(points)[0];
    json out{{"irradiance", numbers(total.irradiance)},
             {"direct", numbers(light.at(points, Component::direct)[0].irradiance)},
             {"indirect", numbers(light.at(points, Component::indirect)[0].irradiance)}};
    const Locator locator(solution.scene);
    const SurfaceId s = locator.find(point.x, point.n);
    if (total.on_surface && !s.is_none()) {
        const Scene& scene = solution.scene;
        const Surface& surface = scene.surfaces()[s];
        const ElementLocator elements(solution.interpolant.tree, scene.regions().size());
        const ElementId e = elements.find(surface.region, point.x).element;
        out["radiosity"] = numbers(total.radiosity);
        out["surface"] = s.value, out["line"] = surface.line;
        out["material"] = scene.material(s).name;
        out["group"] = surface.group.is_none() ? "" : scene.groups()[surface.group];
        out["element"] = e.is_none() ? json(nullptr) : json(e.value);
        out["links"] = links_at(solution, surface.region, point.x);
    }
    return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string viewer_line_json(const RadiosityFunction& light, const Point& from, const Point& to, const Normal& n,
                             std::size_t count) {
    std::vector<ProbePoint> points;
    for (std::size_t i = 0; i < count; ++i) {
        const double t = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0;
        points.push_back({from + t * (to - from), n});
    }
    json values = json::array();
    for (const Light& l : light.at(points)) values.push_back(mean(l.irradiance));
    return json{{"length", norm(to - from)}, {"values", std::move(values)}}.dump();
}

}  // namespace exitance
