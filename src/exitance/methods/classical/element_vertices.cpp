#include "exitance/methods/classical/element_vertices.hpp"

#include <cmath>

namespace exitance {

void ElementVertices::update(const Stage& stage, const ElementTree& tree, std::span<const ElementId> leaves) {
    constexpr double drawn_in = 1e-4;  // of the way to the middle of the element
    of_leaf.assign(leaves.size(), {});
    const double grid = 1e-6 * stage.scene.size();
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        const ElementId leaf = leaves[i];
        const Point middle = tree.patch(leaf).at(tree.centre(leaf));
        for (const Point& p : tree.outline(leaf)) {
            const auto [entry, fresh] = known_.try_emplace(
                {tree.region(leaf).value, std::llround(p.x / grid), std::llround(p.y / grid), std::llround(p.z / grid)},
                static_cast<std::uint32_t>(at.size()));
            if (fresh) at.push_back(p + drawn_in * (middle - p)), region.push_back(tree.region(leaf));
            of_leaf[i].push_back(entry->second);
        }
    }
}

}  // namespace exitance
