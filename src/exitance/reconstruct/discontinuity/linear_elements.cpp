#include <cmath>

#include "exitance/reconstruct/discontinuity/discontinuity_mesh.hpp"

namespace exitance {

ElementFunction linear_elements(const SixNodeMesh& mesh, const Scene& scene) {
    ElementFunction out;
    std::vector<std::uint32_t> triangle_of;
    for (std::uint32_t t = 0; t < mesh.size(); ++t) {
        const auto& n = mesh.nodes[t];
        const Point& o = mesh.points[n[0]];
        const Patch patch{o, mesh.points[n[1]] - o, mesh.points[n[2]] - o, Patch::Shape::triangle};
        const double square = squared_norm(cross(patch.a, patch.b));
        constexpr double flat = 1e-24;  // (area / size^2)^2: no places can be told from one another within it
        if (!(square > flat * std::pow(scene.size(), 4))) continue;
        const ElementId root = out.tree.add_root(mesh.region[t], patch);
        out.tree.split(root, Cut::both);
        triangle_of.push_back(t);
    }
    out.first_value.resize(out.tree.size());
    for (std::size_t i = 0; i < out.tree.roots().size(); ++i) {
        const ElementId root = out.tree.roots()[i];
        for (const ElementId child : out.tree.children(root)) {
            out.first_value[child] = static_cast<std::uint32_t>(out.values.size());
            for (int k = 0; k < 3; ++k)
                out.add_value(
                    mesh.at(triangle_of[i], out.tree.patch(root).coordinates(out.tree.patch(child).corner(k))));
        }
    }
    return out;
}

}  // namespace exitance
