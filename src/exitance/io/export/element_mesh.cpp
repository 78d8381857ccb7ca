#include "exitance/io/export/element_mesh.hpp"

#include <numeric>
#include <optional>

#include "exitance/scene/locator.hpp"

namespace exitance {
namespace {

/// Finds the face that a leaf shows. Only regions of several faces need a search.
class FaceFinder {
  public:
    explicit FaceFinder(const Scene& scene) : scene_(scene) {}

    SurfaceId find(RegionId r, const Point& centre) {
        const Region& region = scene_.regions()[r];
        if (region.surfaces.size() > 1) {
            if (!locator_) locator_.emplace(scene_);
            const SurfaceId found = locator_->find(centre, region.plane.n);
            if (!found.is_none() && scene_.surfaces()[found].region == r) return found;
        }
        return region.surfaces.front();
    }

  private:
    const Scene& scene_;
    std::optional<Locator> locator_;
};

/// Converts Clough-Tocher elements to VTK's Lagrange triangles of degree three, which represent them exactly: three per
/// element, each between an edge and the centroid. Corners, and points of edges across which light is continuous, are
/// shared.
class CubicCells {
  public:
    static constexpr std::size_t nodes = 10;

    explicit CubicCells(const SixNodeMesh& from) : from_(from) {
        if (from.is_clough_tocher()) corner_.resize(from.points.size(), none), thirds_.resize(from.points.size(), none);
    }

    void add(std::uint32_t t, ElementMesh& mesh) {
        std::array<std::uint32_t, 3> corner, edge;
        std::array<std::array<std::uint32_t, 2>, 3> spoke;
        std::array<Weights, 3> at{};
        for (std::size_t i = 0; i < 3; ++i) at[i][i] = 1;
        const Weights centre{1.0 / 3, 1.0 / 3, 1.0 / 3};
        for (std::size_t i = 0; i < 3; ++i) {
            std::uint32_t& shared = corner_[from_.nodes[t][i]];
            if (shared == none) shared = put(t, at[i], mesh);
            corner[i] = shared;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const Weights &a = at[i], &b = at[(i + 1) % 3];
            // The first element of an edge creates its two points, ordered from a to b; its neighbour uses them.
            std::uint32_t& shared = thirds_[from_.nodes[t][3 + i]];
            edge[i] = shared;
            if (shared != none) continue;
            shared = edge[i] = put(t, between(a, b, 1), mesh);
            put(t, between(a, b, 2), mesh);
        }
        for (std::size_t i = 0; i < 3; ++i)
            spoke[i] = {put(t, between(at[i], centre, 1), mesh), put(t, between(at[i], centre, 2), mesh)};
        const std::uint32_t middle = put(t, centre, mesh);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            const Point& a = mesh.points[corner[i]];
            const bool runs = squared_norm(mesh.points[edge[i]] - a) <= squared_norm(mesh.points[edge[i] + 1] - a);
            const std::uint32_t first = runs ? edge[i] : edge[i] + 1, second = runs ? edge[i] + 1 : edge[i];
            Weights inner{};
            for (std::size_t k = 0; k < 3; ++k) inner[k] = (at[i][k] + at[j][k] + centre[k]) / 3;
            for (const std::uint32_t p : {corner[i], corner[j], middle, first, second, spoke[j][0], spoke[j][1],
                                          spoke[i][1], spoke[i][0], put(t, inner, mesh)})
                mesh.connectivity.push_back(p);
        }
    }

  private:
    using Weights = std::array<double, 3>;
    static constexpr std::uint32_t none = 0xffffffffu;

    static Weights between(const Weights& a, const Weights& b, int thirds) {
        Weights out{};
        for (std::size_t k = 0; k < 3; ++k) out[k] = ((3 - thirds) * a[k] + thirds * b[k]) / 3;
        return out;
    }

    std::uint32_t put(std::uint32_t t, const Weights& L, ElementMesh& mesh) {
        Point place;
        for (std::size_t k = 0; k < 3; ++k) place += L[k] * from_.points[from_.nodes[t][k]];
        const Spectrum light = from_.at(t, {L[1], L[2]});
        mesh.points.push_back(place);
        mesh.irradiance.emplace_back();
        for (std::size_t b = 0; b < bands; ++b) mesh.irradiance.back()[b] = static_cast<float>(light[b]);
        return static_cast<std::uint32_t>(mesh.points.size() - 1);
    }

    const SixNodeMesh& from_;
    /// Points by node: corners, and the first inner point of an edge by the edge's middle node.
    std::vector<std::uint32_t> corner_, thirds_;
};

}  // namespace

std::vector<std::int64_t> ElementMesh::cell_points() const {
    std::vector<std::int64_t> out(connectivity.begin(), connectivity.end());
    if (out.empty()) {
        out.resize(points.size());
        std::iota(out.begin(), out.end(), 0);
    }
    return out;
}

std::vector<std::uint8_t> ElementMesh::cell_types() const {
    constexpr std::uint8_t quadratic_triangle = 22, lagrange_triangle = 69;
    std::vector<std::uint8_t> out(size(), cells == Cells::cubic ? lagrange_triangle : quadratic_triangle);
    for (std::size_t i = 0; i < size() && cells == Cells::polygons; ++i) out[i] = vtk_cell_type(corner_count(i));
    return out;
}

ElementMesh make_cells(const Solution& solution) {
    const SixNodeMesh& from = solution.discontinuity;
    if (from.empty()) return make_element_mesh(solution);
    ElementMesh mesh;
    FaceFinder finder(solution.scene);
    CubicCells cubics(from);
    mesh.cells = from.is_clough_tocher() ? ElementMesh::Cells::cubic : ElementMesh::Cells::quadratic;
    if (!from.is_clough_tocher()) mesh.points = from.points, mesh.irradiance = from.values;
    mesh.radiosity.resize(mesh.points.size());
    for (std::uint32_t t = 0; t < from.size(); ++t) {
        const std::size_t before = mesh.connectivity.size();
        if (from.is_clough_tocher())
            cubics.add(t, mesh);
        else
            mesh.connectivity.insert(mesh.connectivity.end(), from.nodes[t].begin(), from.nodes[t].end());
        const std::size_t nodes = from.is_clough_tocher() ? CubicCells::nodes : from.nodes[t].size();
        const RegionId region = from.region[t];
        const Material& material = solution.scene.material(region);
        mesh.radiosity.resize(mesh.points.size());
        for (std::size_t i = before; i < mesh.connectivity.size(); ++i) {
            const std::uint32_t n = mesh.connectivity[i];
            for (std::size_t b = 0; b < bands; ++b)
                mesh.radiosity[n][b] = static_cast<float>(
                    material.exitance[b] + material.reflectance[b] * static_cast<double>(mesh.irradiance[n][b]));
        }
        const SurfaceId face = finder.find(region, from.centre(t));
        for (std::size_t end = before + nodes; end <= mesh.connectivity.size(); end += nodes) {
            mesh.first_point.push_back(static_cast<std::uint32_t>(end));
            mesh.surface.push_back(static_cast<std::int32_t>(face.value));
            mesh.region.push_back(static_cast<std::int32_t>(region.value));
            mesh.material.push_back(static_cast<std::int32_t>(solution.scene.regions()[region].material.value));
            mesh.group.push_back(static_cast<std::int32_t>(solution.scene.surfaces()[face].group.value));
        }
    }
    return mesh;
}

void CornerWalk::next() {
    if (++at_ < corners_.size()) return;
    while (!tree_.is_leaf(ElementId(next_leaf_))) ++next_leaf_;
    leaf_ = ElementId(next_leaf_++);
    corners_ = tree_.domain(leaf_);
    at_ = 0;
}

std::vector<std::int32_t> faces_of_leaves(const Solution& solution) {
    const ElementTree& tree = solution.interpolant.tree;
    FaceFinder finder(solution.scene);
    std::vector<std::int32_t> out;
    out.reserve(tree.size());
    for (ElementId e : tree.ids())
        if (tree.is_leaf(e))
            out.push_back(
                static_cast<std::int32_t>(finder.find(tree.region(e), tree.patch(e).at(tree.centre(e))).value));
    return out;
}

ElementMesh make_element_mesh(const Solution& solution) {
    const Scene& scene = solution.scene;
    const ElementTree& tree = solution.interpolant.tree;
    ElementMesh mesh;
    mesh.points.reserve(solution.interpolant.values.size());
    mesh.irradiance.reserve(solution.interpolant.values.size());
    mesh.radiosity.reserve(solution.interpolant.values.size());
    FaceFinder finder(scene);
    for (ElementId e : tree.ids()) {
        if (!tree.is_leaf(e)) continue;
        const RegionId region = tree.region(e);
        const Material& material = scene.material(region);
        const Patch& patch = tree.patch(e);
        const auto add_point = [&](Vec2 uv) {
            const Spectrum irradiance = solution.interpolant.at({e, uv});
            mesh.points.push_back(patch.at(uv));
            mesh.irradiance.emplace_back(), mesh.radiosity.emplace_back();
            for (std::size_t b = 0; b < bands; ++b) {
                mesh.irradiance.back()[b] = static_cast<float>(irradiance[b]);
                mesh.radiosity.back()[b] =
                    static_cast<float>(material.exitance[b] + material.reflectance[b] * irradiance[b]);
            }
        };
        if (tree.is_cell(e))
            for (const Vec2 uv : tree.domain(e)) add_point(uv);
        else
            for (int i = 0; i < patch.corner_count(); ++i) add_point(patch.corner_uv(i));
        mesh.first_point.push_back(static_cast<std::uint32_t>(mesh.points.size()));

        const SurfaceId face = finder.find(region, patch.at(tree.centre(e)));
        mesh.surface.push_back(static_cast<std::int32_t>(face.value));
        mesh.region.push_back(static_cast<std::int32_t>(region.value));
        mesh.material.push_back(static_cast<std::int32_t>(scene.regions()[region].material.value));
        mesh.group.push_back(static_cast<std::int32_t>(scene.surfaces()[face].group.value));
    }
    return mesh;
}

}  // namespace exitance
