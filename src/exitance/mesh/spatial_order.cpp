#include "exitance/mesh/spatial_order.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exitance/base/vec.hpp"

namespace exitance {
namespace {

constexpr int bits = 20;  ///< Bits per coordinate.

std::uint64_t spread(std::uint64_t v) {
    v = (v | v << 32) & 0x001f00000000ffffu;
    v = (v | v << 16) & 0x001f0000ff0000ffu;
    v = (v | v << 8) & 0x100f00f00f00f00fu;
    v = (v | v << 4) & 0x10c30c30c30c30c3u;
    return (v | v << 2) & 0x1249249249249249u;
}

}  // namespace

void sort_by_place(const ElementTree& tree, std::vector<ElementId>& elements) {
    Box box;
    for (const ElementId e : elements) box.add(tree.patch(e).centre());
    const Vec3 size = box.hi - box.lo;
    const double longest = std::max({size.x, size.y, size.z});
    if (!(longest > 0) || !std::isfinite(longest)) return;
    constexpr double cells = (1 << bits) - 1;
    const auto cell = [&](double x, double low) {
        return spread(static_cast<std::uint64_t>(std::clamp((x - low) / longest, 0.0, 1.0) * cells));
    };
    std::vector<std::pair<std::uint64_t, ElementId>> keyed;
    keyed.reserve(elements.size());
    for (const ElementId e : elements) {
        const Point x = tree.patch(e).centre();
        keyed.emplace_back(cell(x.x, box.lo.x) | cell(x.y, box.lo.y) << 1 | cell(x.z, box.lo.z) << 2, e);
    }
    std::stable_sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < elements.size(); ++i) elements[i] = keyed[i].second;
}

}  // namespace exitance
