#include "exitance/io/export/element_mesh.hpp"

#include <numeric>
#include <optional>

#include "exitance/scene/locator.hpp"

namespace exitance {
namespace {

/// Which face a leaf shows; only regions of several faces need a search.
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
    constexpr std::uint8_t quadratic_triangle = 22;
    std::vector<std::uint8_t> out(size(), quadratic_triangle);
    for (std::size_t i = 0; i < size() && !is_quadratic; ++i) out[i] = vtk_cell_type(corner_count(i));
    return out;
}

ElementMesh make_cells(const Solution& solution) {
    const SixNodeMesh& from = solution.discontinuity;
    if (from.empty()) return make_element_mesh(solution);
    const Scene& scene = solution.scene;
    ElementMesh mesh;
    mesh.is_quadratic = true;
    mesh.points = from.points, mesh.irradiance = from.values, mesh.radiosity = from.values;
    FaceFinder finder(scene);
    for (std::uint32_t t = 0; t < from.size(); ++t) {
        const RegionId region = from.region[t];
        const Material& material = scene.material(region);
        for (const std::uint32_t n : from.nodes[t]) {
            mesh.connectivity.push_back(n);
            const Spectrum light = from.value(n);
            for (std::size_t b = 0; b < bands; ++b)
                mesh.radiosity[n][b] = static_cast<float>(material.exitance[b] + material.reflectance[b] * light[b]);
        }
        mesh.first_point.push_back(static_cast<std::uint32_t>(mesh.connectivity.size()));
        const SurfaceId face = finder.find(region, from.centre(t));
        mesh.surface.push_back(static_cast<std::int32_t>(face.value));
        mesh.region.push_back(static_cast<std::int32_t>(region.value));
        mesh.material.push_back(static_cast<std::int32_t>(scene.regions()[region].material.value));
        mesh.group.push_back(static_cast<std::int32_t>(scene.surfaces()[face].group.value));
    }
    return mesh;
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
