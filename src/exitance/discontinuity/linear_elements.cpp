#include <cmath>

#include "exitance/discontinuity/discontinuity_mesh.hpp"

namespace exitance {

ElementFunction linear_elements(const SixNodeMesh& mesh, const Scene& scene) {
    ElementFunction out;
    std::vector<std::uint32_t> triangle_of;  // the triangle of each element
    for (std::uint32_t t = 0; t < mesh.size(); ++t) {
        const auto& n = mesh.nodes[t];
        const Point& o = mesh.points[n[0]];
        const Patch patch{o, mesh.points[n[1]] - o, mesh.points[n[2]] - o, Patch::Shape::triangle};
        const double square = squared_norm(cross(patch.a, patch.b));
        constexpr double flat = 1e-24;  // (area / size^2)^2, derived from rounding: thinner triangles are degenerate
        if (!(square > flat * std::pow(scene.size(), 4))) continue;
        const ElementId root = out.tree.add_root(mesh.region[t], patch);
        const ElementId first = out.tree.split(root, Cut::both);
        // Cubic elements span larger triangles at the same error, so they are split once more.
        constexpr std::uint32_t parts = 4;
        for (std::uint32_t i = 0; i < parts && mesh.is_clough_tocher(); ++i)
            out.tree.split(ElementId(first.value + i), Cut::both);
        triangle_of.resize(out.tree.size(), t);
    }
    out.first_value.resize(out.tree.size());
    for (const ElementId part : out.tree.leaves()) {
        const std::uint32_t t = triangle_of[part.value];
        const auto& n = mesh.nodes[t];
        const Point& o = mesh.points[n[0]];
        const Patch whole{o, mesh.points[n[1]] - o, mesh.points[n[2]] - o, Patch::Shape::triangle};
        out.first_value[part] = static_cast<std::uint32_t>(out.values.size());
        for (int k = 0; k < 3; ++k) out.add_value(mesh.at(t, whole.coordinates(out.tree.patch(part).corner(k))));
    }
    return out;
}

}  // namespace exitance
