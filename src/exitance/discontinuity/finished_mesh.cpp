#include "exitance/discontinuity/finished_mesh.hpp"

namespace exitance {

SixNodeMesh finished_mesh(const BisectionMesh& mesh, std::span<const Spectrum> values,
                          std::span<const RegionId> region_of_face) {
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
    for (const BisectionMesh::Triangle& t : mesh.triangles()) {
        std::array<std::uint32_t, 6> nodes;
        for (std::size_t k = 0; k < 3; ++k) nodes[k] = add(t.corner[k]), nodes[3 + k] = add(t.middle[k]);
        out.nodes.push_back(nodes);
        out.region.push_back(region_of_face[t.face]);
        out.edge_order.push_back(t.order);
    }
    return out;
}

}  // namespace exitance
