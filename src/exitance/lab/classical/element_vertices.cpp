#include "exitance/lab/classical/element_vertices.hpp"

#include <cmath>

namespace exitance {

void ElementVertices::add(const Stage& stage, const ElementTree& tree, std::span<const ElementId> elements) {
    constexpr double drawn_in = 1e-4;  // share of the way to the centre of the element
    const double grid = 1e-6 * stage.scene.size();
    for (const ElementId e : elements) {
        const Point middle = tree.patch(e).at(tree.centre(e));
        std::vector<std::uint32_t>& around = of_element.emplace_back();
        for (const Point& p : tree.outline(e)) {
            const auto [entry, is_new] = known_.try_emplace(
                {tree.region(e).value, std::llround(p.x / grid), std::llround(p.y / grid), std::llround(p.z / grid)},
                static_cast<std::uint32_t>(at.size()));
            if (is_new) at.push_back(p + drawn_in * (middle - p)), region.push_back(tree.region(e));
            around.push_back(entry->second);
        }
    }
}

}  // namespace exitance
