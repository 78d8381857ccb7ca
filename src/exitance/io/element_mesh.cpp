#include "exitance/io/element_mesh.hpp"

#include <optional>

#include "exitance/io/solution_groups.hpp"
#include "exitance/scene/locator.hpp"

namespace exitance {
namespace {

/// The face at the centre of each leaf.
std::vector<std::int32_t> faces_of(const Scene& scene, const ElementTree& tree, const std::vector<ElementId>& leaves) {
    std::optional<Locator> locator;  // only cut-up regions need one
    std::vector<std::int32_t> out;
    out.reserve(leaves.size());
    for (ElementId e : leaves) {
        const Region& region = scene.regions()[tree.region(e)];
        SurfaceId face = region.surfaces.empty() ? SurfaceId(0u) : region.surfaces.front();
        if (region.surfaces.size() > 1) {
            if (!locator) locator.emplace(scene);
            const SurfaceId found = locator->find(tree.patch(e).centre(), region.plane.n);
            if (!found.is_none() && scene.surfaces()[found].region == tree.region(e)) face = found;
        }
        out.push_back(static_cast<std::int32_t>(face.value));
    }
    return out;
}

}  // namespace

ElementMesh make_element_mesh(const Solution& solution) {
    const Scene& scene = solution.scene;
    const ElementTree& tree = solution.interpolant.tree;
    ElementMesh mesh;
    mesh.leaves = tree.leaves();
    mesh.irradiance = leaf_values(solution.interpolant);
    mesh.surface = faces_of(scene, tree, mesh.leaves);
    mesh.points.reserve(mesh.irradiance.size() / bands * 3);
    mesh.radiosity.reserve(mesh.irradiance.size());
    for (std::size_t i = 0; i < mesh.leaves.size(); ++i) {
        const ElementId e = mesh.leaves[i];
        const Patch& patch = tree.patch(e);
        const Material& material = scene.material(tree.region(e));
        for (int corner = 0; corner < patch.corner_count(); ++corner) {
            const Point p = patch.corner(corner);
            mesh.points.insert(mesh.points.end(), {p.x, p.y, p.z});
            for (std::size_t b = 0; b < bands; ++b)
                mesh.radiosity.push_back(static_cast<float>(
                    material.exitance[b] +
                    material.reflectance[b] * static_cast<double>(mesh.irradiance[mesh.radiosity.size()])));
        }
        mesh.region.push_back(static_cast<std::int32_t>(tree.region(e).value));
        mesh.material.push_back(static_cast<std::int32_t>(scene.regions()[tree.region(e)].material.value));
        const SurfaceId face(static_cast<std::size_t>(mesh.surface[i]));
        mesh.group.push_back(static_cast<std::int32_t>(scene.surfaces()[face].group.value));
    }
    return mesh;
}

}  // namespace exitance
