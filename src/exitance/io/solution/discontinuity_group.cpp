#include <algorithm>
#include <cmath>

#include "exitance/io/export/element_mesh.hpp"
#include "exitance/io/solution/solution_groups.hpp"

namespace exitance {
namespace {

using Slopes = std::array<SixNodeMesh::Slope, 3>;

std::vector<float> flat_slopes(const std::vector<Slopes>& slopes) {
    std::vector<float> out;
    for (const Slopes& three : slopes)
        for (const SixNodeMesh::Slope& slope : three) out.insert(out.end(), slope.begin(), slope.end());
    return out;
}

std::vector<Slopes> rows_of_slopes(const std::vector<float>& flat) {
    std::vector<Slopes> out(flat.size() / (3 * bands));
    for (std::size_t i = 0; i < flat.size(); ++i) out[i / (3 * bands)][i / bands % 3][i % bands] = flat[i];
    return out;
}

void read_slopes(Hdf5Reader& file, const std::string& group, SixNodeMesh& mesh) {
    const auto gradients = file.read<float>(group + "/gradients", 3 * bands);
    const auto of = file.read<std::uint32_t>(group + "/gradient_of", 3, mesh.size());
    const auto slopes = file.read<float>(group + "/slopes", 3 * bands, mesh.size());
    if (file.failed()) return;
    mesh.gradients = rows_of_slopes(gradients), mesh.slopes = rows_of_slopes(slopes);
    for (std::size_t t = 0; t < mesh.size(); ++t) mesh.gradient_of.push_back({of[3 * t], of[3 * t + 1], of[3 * t + 2]});
}

bool is_order(std::uint8_t v) {
    return v <= 4 || v == 255;
}

/// Returns the reason why a mesh is invalid, or nothing.
std::optional<std::string> find_nonsense(const SixNodeMesh& mesh, std::size_t region_count) {
    for (const Point& p : mesh.points)
        if (!is_finite(p)) return "holds a point that is not finite";
    for (const auto& value : mesh.values)
        for (const float v : value)
            if (!std::isfinite(v)) return "holds a value that is not finite";
    for (const auto& triangle : mesh.nodes)
        for (const std::uint32_t n : triangle)
            if (n >= mesh.points.size()) return "leads to a node that does not exist";
    for (const auto* slopes : {&mesh.gradients, &mesh.slopes})
        for (const Slopes& three : *slopes)
            for (const SixNodeMesh::Slope& slope : three)
                for (const float v : slope)
                    if (!std::isfinite(v)) return "holds a slope that is not finite";
    for (const auto& triangle : mesh.gradient_of)
        for (const std::uint32_t g : triangle)
            if (g >= mesh.gradients.size()) return "leads to a gradient that does not exist";
    for (const RegionId r : mesh.region)
        if (r.value >= region_count) return "names a region that does not exist";
    for (const DiscontinuityCurve& c : mesh.curves)
        if (c.region.value >= region_count || (!c.source.is_none() && c.source.value >= region_count) ||
            !is_finite(c.a) || !is_finite(c.b))
            return "holds a curve that makes no sense";
    return {};
}

}  // namespace

void write_discontinuity(Hdf5Writer& file, const std::string& group, const SixNodeMesh& mesh) {
    std::vector<std::uint32_t> nodes, region, curve_region, curve_source;
    std::vector<std::uint8_t> edge_order, shadow, curve_order, curve_cause;
    std::vector<double> ends;
    for (std::size_t t = 0; t < mesh.size(); ++t) {
        nodes.insert(nodes.end(), mesh.nodes[t].begin(), mesh.nodes[t].end());
        region.push_back(mesh.region[t].value);
        for (const CurveOrder o : mesh.edge_order[t]) edge_order.push_back(static_cast<std::uint8_t>(o));
        shadow.push_back(static_cast<std::uint8_t>(mesh.shadow[t]));
    }
    for (const DiscontinuityCurve& c : mesh.curves) {
        curve_region.push_back(c.region.value), curve_source.push_back(c.source.value);
        curve_order.push_back(static_cast<std::uint8_t>(c.order));
        curve_cause.push_back(static_cast<std::uint8_t>(c.cause));
        ends.insert(ends.end(), {c.a.x, c.a.y, c.a.z, c.b.x, c.b.y, c.b.z});
    }
    const auto in = [&](const char* name) { return group + "/" + name; };
    file.make_group(group);
    file.write(in("points"), numbers_of(mesh.points), 3, {"m", "nodes"});
    file.write(in("values"), numbers_of(mesh.values), bands, {"W/m^2", "irradiance at the nodes"});
    file.write(in("nodes"), nodes, 6, {"1", "nodes of a triangle: corners, then the middles of edges 01, 12, 20"});
    file.write(in("region"), region, 1, {"1", "region of a triangle"});
    file.write(in("edge_order"), edge_order, 3,
               {"1", "of edges 01, 12, 20: 0 border, 1 D0, 2 D1, 3 D2, 4 EEE, 255 none"});
    file.write(in("shadow"), shadow, 1, {"1", "of a triangle: 0 lit, 1 penumbra, 2 umbra"});
    if (mesh.is_clough_tocher()) {
        std::vector<std::uint32_t> of;
        for (const auto& three : mesh.gradient_of) of.insert(of.end(), three.begin(), three.end());
        file.write(in("gradients"), flat_slopes(mesh.gradients), 3 * bands,
                   {"W/m^3", "slopes of irradiance at corners along x, y, z, a row of bands each"});
        file.write(in("gradient_of"), of, 3, {"1", "gradients of a triangle's corners"});
        file.write(in("slopes"), flat_slopes(mesh.slopes), 3 * bands,
                   {"W/m^3", "of a triangle at the middles of edges 01, 12, 20, inwards at a right angle, likewise"});
    }
    file.write(in("curve_region"), curve_region, 1, {"1", "region that a curve lies on"});
    file.write(in("curve_ends"), ends, 6, {"m", "where a curve begins and ends"});
    file.write(in("curve_order"), curve_order, 1, {"1", "order of a curve: 1 D0, 2 D1, 3 D2, 4 D2 of three edges"});
    file.write(in("curve_cause"), curve_cause, 1,
               {"1", "0 contact, 1 vertex-edge, 2 edge-vertex, 3 blocker's edge, 4 three edges"});
    file.write(in("curve_source"), curve_source, 1, {"1", "region that emits; 4294967295: none"});
}

SixNodeMesh read_discontinuity(Hdf5Reader& file, const std::string& group, std::size_t region_count) {
    SixNodeMesh mesh;
    const auto in = [&](const char* name) { return group + "/" + name; };
    const auto points = file.read<double>(in("points"), 3);
    const auto values = file.read<float>(in("values"), bands, points.size() / 3);
    const auto nodes = file.read<std::uint32_t>(in("nodes"), 6);
    const std::size_t triangles = nodes.size() / 6;
    const auto region = file.read<std::uint32_t>(in("region"), 1, triangles);
    const auto edge_order = file.read<std::uint8_t>(in("edge_order"), 3, triangles);
    const auto shadow = file.read<std::uint8_t>(in("shadow"), 1, triangles);
    const auto curve_region = file.read<std::uint32_t>(in("curve_region"));
    const std::size_t curves = curve_region.size();
    const auto ends = file.read<double>(in("curve_ends"), 6, curves);
    const auto order = file.read<std::uint8_t>(in("curve_order"), 1, curves);
    const auto cause = file.read<std::uint8_t>(in("curve_cause"), 1, curves);
    const auto source = file.read<std::uint32_t>(in("curve_source"), 1, curves);
    if (file.failed()) return {};
    const bool known = std::all_of(edge_order.begin(), edge_order.end(), is_order) &&
                       std::all_of(shadow.begin(), shadow.end(), [](std::uint8_t v) { return v <= 2; }) &&
                       std::all_of(order.begin(), order.end(), is_order) &&
                       std::all_of(cause.begin(), cause.end(), [](std::uint8_t v) { return v <= 4; });
    if (!known) return file.fail(in("edge_order"), "or a related data set holds an unknown kind"), SixNodeMesh();
    for (std::size_t i = 0; i < points.size() / 3; ++i) {
        mesh.points.push_back({points[3 * i], points[3 * i + 1], points[3 * i + 2]});
        mesh.values.emplace_back();
        std::copy_n(&values[bands * i], bands, mesh.values.back().begin());
    }
    for (std::size_t t = 0; t < triangles; ++t) {
        std::copy_n(&nodes[6 * t], 6, mesh.nodes.emplace_back().begin());
        mesh.region.emplace_back(region[t]);
        mesh.shadow.push_back(static_cast<ShadowClass>(shadow[t]));
        mesh.edge_order.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) mesh.edge_order.back()[k] = static_cast<CurveOrder>(edge_order[3 * t + k]);
    }
    for (std::size_t i = 0; i < curves; ++i) {
        const double* e = &ends[6 * i];
        mesh.curves.push_back({RegionId(curve_region[i]),
                               {e[0], e[1], e[2]},
                               {e[3], e[4], e[5]},
                               static_cast<CurveOrder>(order[i]),
                               static_cast<CurveCause>(cause[i]),
                               RegionId(source[i])});
    }
    if (file.has(in("slopes"))) read_slopes(file, group, mesh);
    if (file.failed()) return {};
    if (const auto wrong = find_nonsense(mesh, region_count)) return file.fail(in("points"), *wrong), SixNodeMesh();
    return mesh;
}

}  // namespace exitance
