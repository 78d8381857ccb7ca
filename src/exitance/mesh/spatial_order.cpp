#include "exitance/mesh/spatial_order.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exitance/base/morton.hpp"

namespace exitance {

void sort_by_place(const ElementTree& tree, std::vector<ElementId>& elements) {
    Box box;
    for (const ElementId e : elements) box.add(tree.patch(e).centre());
    const Vec3 size = box.hi - box.lo;
    const double longest = std::max({size.x, size.y, size.z});
    if (!(longest > 0) || !std::isfinite(longest)) return;
    box.hi = box.lo + Vec3{longest, longest, longest};  // the curve's cells are cubes
    std::vector<std::pair<std::uint64_t, ElementId>> keyed;
    keyed.reserve(elements.size());
    for (const ElementId e : elements) keyed.emplace_back(morton(tree.patch(e).centre(), box), e);
    std::stable_sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < elements.size(); ++i) elements[i] = keyed[i].second;
}

}  // namespace exitance
