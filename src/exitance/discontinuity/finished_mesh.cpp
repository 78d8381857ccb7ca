#include "exitance/discontinuity/finished_mesh.hpp"

#include <optional>

namespace exitance {

SixNodeMesh finished_mesh(const BisectionMesh& mesh, std::span<const Spectrum> values,
                          std::span<const RegionId> region_of_face,
                          const std::function<ShadowClass(std::uint32_t face, const Point& at)>& class_of) {
    SixNodeMesh out;
    std::vector<std::uint32_t> number(mesh.nodes().size(), BisectionMesh::none);
    const auto add = [&](std::uint32_t node) {
        if (number[node] == BisectionMesh::none) {
            number[node] = static_cast<std::uint32_t>(out.points.size());
            out.points.push_back(mesh.nodes()[node].at);
            out.values.emplace_back();
            for (std::size_t b = 0; b < bands; ++b) out.values.back()[b] = static_cast<float>(values[node][b]);
        }
        return number[node];
    };
    std::vector<std::optional<ShadowClass>> classes(region_of_face.size());
    for (std::uint32_t index = 0; index < mesh.triangles().size(); ++index) {
        const BisectionMesh::Triangle& t = mesh.triangles()[index];
        std::array<std::uint32_t, 6> nodes;
        for (std::size_t k = 0; k < 3; ++k) nodes[k] = add(t.corner[k]), nodes[3 + k] = add(t.middle[k]);
        out.nodes.push_back(nodes);
        out.region.push_back(region_of_face[t.face]);
        out.edge_order.push_back(t.order);
        std::optional<ShadowClass>& shadow = classes[t.face];
        if (!shadow) shadow = class_of(t.face, mesh.centre(index));
        out.shadow.push_back(*shadow);
    }
    return out;
}

}  // namespace exitance
