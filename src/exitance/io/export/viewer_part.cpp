#include "exitance/io/export/viewer_part.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "exitance/base/check.hpp"
#include "exitance/io/pictures/tone_map.hpp"

namespace exitance {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers travel as they lie in memory");

constexpr std::uint32_t none = 0xffffffffu, six_nodes = 256 + 6;
constexpr std::uint32_t no_label = 255;

/// Values at the corners of a leaf, if they differ from those of the layer's function.
using CornerValues = std::vector<Spectrum>;

struct Part {
    std::vector<float> positions, irradiance;
    std::vector<std::uint32_t> faces;

    void add(const Point& p, const Spectrum& value) {
        for (const double x : {p.x, p.y, p.z}) positions.push_back(static_cast<float>(x));
        for (const double e : red_green_blue(value)) irradiance.push_back(static_cast<float>(e));
    }
    void add_face(std::uint32_t shape, const Scene& scene, RegionId region, std::uint32_t element,
                  std::uint32_t labels) {
        const Region& r = scene.regions()[region];
        const GroupId group = r.surfaces.empty() ? GroupId() : scene.surfaces()[r.surfaces[0]].group;
        for (const std::uint32_t x :
             {shape, r.material.value, element, r.surfaces.empty() || group.is_none() ? none : group.value, labels})
            faces.push_back(x);
    }
};

template <class T>
void append(std::string& out, const std::vector<T>& values) {
    out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

std::uint32_t labels_of(std::uint32_t shadow, const std::array<std::uint32_t, 3>& orders) {
    return shadow | orders[0] << 8 | orders[1] << 16 | orders[2] << 24;
}

const ElementFunction& function_of(const Solution& solution, ViewerLayer layer) {
    if (layer == ViewerLayer::exported) return solution.interpolant;
    // Links that the solution keeps come with the elements of the method; otherwise those of the solution are drawn.
    const bool keeps = layer == ViewerLayer::raw && !solution.links.links.empty();
    return keeps ? solution.links.elements : solution.indirect;
}

/// True if `export` writes a mesh of triangles with six nodes.
bool has_triangles(const Solution& solution, ViewerLayer layer) {
    return layer == ViewerLayer::exported && !solution.discontinuity.empty();
}

void add_leaf(Part& part, const Scene& scene, const ElementFunction& f, ElementId e, const CornerValues& values) {
    const std::vector<Vec2> domain = f.tree.domain(e);
    for (std::size_t i = 0; i < domain.size(); ++i)
        part.add(f.tree.patch(e).at(domain[i]), values.empty() ? f.at({e, domain[i]}) : values[i]);
    part.add_face(static_cast<std::uint32_t>(domain.size()), scene, f.tree.region(e), e.value,
                  labels_of(no_label, {no_label, no_label, no_label}));
}

void add_triangle(Part& part, const Scene& scene, const SixNodeMesh& mesh, std::uint32_t t) {
    for (const std::uint32_t node : mesh.nodes[t]) part.add(mesh.points[node], mesh.value(node));
    std::array<std::uint32_t, 3> orders{};
    for (std::size_t i = 0; i < 3; ++i) orders[i] = static_cast<std::uint32_t>(mesh.edge_order[t][i]);
    const std::uint32_t shadow = t < mesh.shadow.size() ? static_cast<std::uint32_t>(mesh.shadow[t]) : no_label;
    part.add_face(six_nodes, scene, mesh.region[t], t, labels_of(shadow, orders));
}

/// True if the method has one value per element.
bool is_constant(const Solution& solution) {
    return solution.statistics.basis == "constant" || solution.statistics.basis == "haar";
}

/// The method's own values of some leaves: light at the corners; for a constant basis, the same value at all corners.
std::vector<CornerValues> raw_values(const RadiosityFunction& light, const ElementFunction& f,
                                     std::span<const ElementId> leaves) {
    const Solution& solution = light.solution();
    const bool constant = is_constant(solution);
    const Spectrum share = light.exact_share();
    std::vector<ProbePoint> points;
    std::vector<CornerValues> out;
    for (const ElementId e : leaves) {
        const std::vector<Vec2> domain = f.tree.domain(e);
        const Normal n = solution.scene.regions()[f.tree.region(e)].plane.n;
        CornerValues values;
        Point centre;
        for (const Vec2 uv : domain) {
            values.push_back(f.at({e, uv}));
            centre = centre + (1.0 / static_cast<double>(domain.size())) * (f.tree.patch(e).at(uv) - Point());
        }
        constexpr double inwards = 1e-3;
        if (constant) {
            Spectrum sum;
            for (const Spectrum& value : values) sum += value * (1.0 / static_cast<double>(values.size()));
            std::fill(values.begin(), values.end(), sum);
            points.push_back({centre, n});
        } else {
            for (const Vec2 uv : domain) {
                const Point corner = f.tree.patch(e).at(uv);
                points.push_back({corner + inwards * (centre - corner), n});
            }
        }
        out.push_back(std::move(values));
    }
    if (max(share) == 0) return out;
    const std::vector<Light> direct = light.at(points, Component::direct);
    std::size_t k = 0;
    for (CornerValues& values : out) {
        for (Spectrum& value : values) {
            value += share * direct[k].irradiance;
            if (!constant) ++k;
        }
        if (constant) ++k;
    }
    return out;
}

Part make_part(const Solution& solution, ViewerLayer layer, std::size_t number, const RadiosityFunction* light) {
    EXI_CHECK(light || layer != ViewerLayer::raw);
    Part part;
    const std::size_t first = number * viewer_part_leaves;
    if (has_triangles(solution, layer)) {
        const SixNodeMesh& mesh = solution.discontinuity;
        for (std::size_t t = first; t < std::min(mesh.size(), first + viewer_part_leaves); ++t)
            add_triangle(part, solution.scene, mesh, static_cast<std::uint32_t>(t));
        return part;
    }
    const ElementFunction& f = function_of(solution, layer);
    const std::vector<ElementId> all = f.tree.leaves();
    const std::size_t begin = std::min(all.size(), first);
    const std::span<const ElementId> leaves =
        std::span(all).subspan(begin, std::min(all.size() - begin, viewer_part_leaves));
    std::vector<CornerValues> values(leaves.size());
    if (layer == ViewerLayer::raw) values = raw_values(*light, f, leaves);
    for (std::size_t i = 0; i < leaves.size(); ++i) add_leaf(part, solution.scene, f, leaves[i], values[i]);
    return part;
}

}  // namespace

bool find_viewer_layer(const std::string& name, ViewerLayer& layer) {
    if (name == "exported")
        layer = ViewerLayer::exported;
    else if (name == "method")
        layer = ViewerLayer::method;
    else if (name == "raw")
        layer = ViewerLayer::raw;
    else
        return false;
    return true;
}

std::size_t viewer_part_count(const Solution& solution, ViewerLayer layer) {
    const std::size_t leaves = has_triangles(solution, layer) ? solution.discontinuity.size()
                                                              : function_of(solution, layer).tree.leaves().size();
    return std::max<std::size_t>(1, (leaves + viewer_part_leaves - 1) / viewer_part_leaves);
}

std::string viewer_part(const Solution& solution, ViewerLayer layer, std::size_t number,
                        const RadiosityFunction* light) {
    const Part part = make_part(solution, layer, number, light);
    const std::vector<std::uint32_t> counts{static_cast<std::uint32_t>(part.positions.size() / 3),
                                            static_cast<std::uint32_t>(part.faces.size() / 5)};
    std::string out = "EXV2";
    out.reserve(out.size() + 4 * (2 + part.positions.size() + part.irradiance.size() + part.faces.size()));
    append(out, counts), append(out, part.positions), append(out, part.irradiance), append(out, part.faces);
    return out;
}

std::string viewer_part_light(const Solution& solution, ViewerLayer layer, std::size_t number,
                              const RadiosityFunction* light) {
    const Part part = make_part(solution, layer, number, light);
    std::string out = "EXL1";
    append(out, std::vector<std::uint32_t>{static_cast<std::uint32_t>(part.irradiance.size() / 3)});
    append(out, part.irradiance);
    return out;
}

std::vector<Spectrum> viewer_raw_at(const RadiosityFunction& light, std::span<const ProbePoint> points) {
    const Solution& solution = light.solution();
    const ElementFunction& f = function_of(solution, ViewerLayer::raw);
    const Locator locator(solution.scene);
    const ElementLocator elements(f.tree, solution.scene.regions().size());
    const bool constant = is_constant(solution);
    const std::vector<Light> direct = light.at(points, Component::direct);
    std::vector<Spectrum> out(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const SurfaceId s = locator.find(points[i].x, points[i].n);
        if (s.is_none()) continue;
        const ElementTree::Place place = elements.find(solution.scene.surfaces()[s].region, points[i].x);
        if (place.element.is_none()) continue;
        out[i] = constant ? raw_values(light, f, std::span(&place.element, 1))[0][0]
                          : f.at(place) + light.exact_share() * direct[i].irradiance;
    }
    return out;
}

}  // namespace exitance
