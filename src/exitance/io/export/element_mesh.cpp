#include "exitance/io/export/element_mesh.hpp"

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
