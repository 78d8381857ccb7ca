#include "exitance/methods/classical/element_vertices.hpp"

#include <cmath>

namespace exitance {

void ElementVertices::update(const Stage& stage, const ElementTree& tree, std::span<const ElementId> leaves) {
    constexpr double drawn_in = 1e-4;  // of the way to the middle of the element
    of_leaf.assign(leaves.size(), {});
    const double grid = 1e-6 * stage.scene.size();
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        const Patch& patch = tree.patch(leaves[i]);
        for (int k = 0; k < patch.corner_count(); ++k) {
            const Point p = patch.corner(k);
            const auto [entry, fresh] = known_.try_emplace({tree.region(leaves[i]).value, std::llround(p.x / grid),
                                                            std::llround(p.y / grid), std::llround(p.z / grid)},
                                                           static_cast<std::uint32_t>(at.size()));
            if (fresh) at.push_back(p + drawn_in * (patch.centre() - p)), region.push_back(tree.region(leaves[i]));
            of_leaf[i][static_cast<std::size_t>(k)] = entry->second;
        }
    }
}

}  // namespace exitance
